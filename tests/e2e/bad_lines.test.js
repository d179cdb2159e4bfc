// What becomes of a player whose line is slow, loses packets, or is cut for a while.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { launch } from './browser.js';
import { keepDiary, walk } from './lag.js';
import { internet, makeInternet, ownAddress } from './networks.js';
import { signaling } from './programs.js';
import { startSlowLine } from './slow_line.js';

const port = 40_000;
const pause = (ms) => new Promise((proceed) => setTimeout(proceed, ms));

/** A room on the internet, its render server reached at one port of this address. */
async function makeRoom(t, address = internet, serveOptions = []) {
  const net = makeInternet(t);
  if (address !== internet) ownAddress(address);
  const room = await signaling(t, { host: internet });
  room.serve('--udp-port', String(port), '--bind', internet, '--public-ip', address, ...serveOptions);
  return { ...room, net };
}

test('ten seconds without network: back within five, with its own cube, and never "Live" in between', async (t) => {
  const { url, net } = await makeRoom(t);
  const home = net.home('cone');
  const player = await (await launch(t, home.prefix)).open(url);
  assert.equal((await player.lit(40_000)).role.cube, 1);
  const elsewhere = await launch(t, net.home('cone').prefix);
  const [other, watcher] = [await elsewhere.open(url), await elsewhere.open(url)];
  await other.lit(40_000);
  await watcher.until('it watches', ({ role }) => role?.cube === 0);

  home.cut();
  const cutAt = Date.now();
  await pause(2500);
  while (Date.now() - cutAt < 10_000) {
    assert.doesNotMatch(await player.page.locator('#state').innerText(), /^Live/);
    await pause(250);
  }
  assert.match(await player.page.locator('#trouble').innerText(), /network is gone|no connection/i);
  await player.screenshot('network-gone');
  home.mend();
  const { role } = await player
    .until('back', ({ state }) => state === 'live', 5000)
    .then(() => player.lit(2000));
  assert.equal(role.cube, 1);
  const { places } = await player.knows();
  await player.press('ArrowUp', (known) => known.places[0].y > places[0].y);
  await watcher.until('it watches again', (known) => known.role.cube === 0 && known.role.players === 2);
});

const quantile = (values, share) =>
  [...values].sort((a, b) => a - b)[Math.floor(share * (values.length - 1))];

/** What a player has who walks about at the end of a line of 50 ms and 1 % loss each way. */
async function walkOnSlowLine(t, ...serveOptions) {
  const slow = '203.0.113.2';
  const { url, net } = await makeRoom(t, slow, serveOptions);
  await startSlowLine(t, {
    from: { address: slow, port },
    to: { address: internet, port },
    delayMs: 50,
    loss: 0.01,
  });
  const home = net.home('cone');
  home.block(`ip daddr ${internet} udp dport ${port}`);
  const player = await (await launch(t, home.prefix)).open(url, { init: keepDiary });
  await player.lit(40_000);
  const { intervals, lags } = await walk(player, 10_000);
  // Looked at at any moment: how long ago the newest map has come.
  const ages = intervals.flatMap((ms) => Array.from({ length: Math.ceil(ms) }, (_, age) => age));
  const found = { interval: quantile(intervals, 0.5), age: quantile(ages, 0.95), lag: quantile(lags, 0.95) };
  t.diagnostic(
    `${intervals.length} maps, one every ${found.interval.toFixed(0)} ms; p95 of age ${found.age.toFixed(0)} ms; ` +
      `from a move to its map ${quantile(lags, 0.5).toFixed(0)} ms, p95 ${found.lag.toFixed(0)} ms`,
  );
  assert.ok(intervals.length > 40, 'maps come');
  assert.ok(lags.length > 0.9 * intervals.length, 'moves are found in the maps');
  return found;
}

test('50 ms and 1 % loss: maps keep coming, the newest one seldom more than four intervals ago', async (t) => {
  const { interval, age } = await walkOnSlowLine(t);
  assert.ok(age < 4 * interval, `p95 of age is ${age} ms at an interval of ${interval} ms`);
});

// A line that loses 1 % carries some 140 kB/s by SCTP at this delay (Mathis et al. 1997). Faster maps than that wait in
// SCTP's own buffer, which the render server cannot see: their lag is not bounded by intervals.
test('50 ms and 1 % loss: at a rate that such a line carries, a move is seen within four intervals', async (t) => {
  const { interval, lag } = await walkOnSlowLine(t, '--rate', '6');
  assert.ok(lag < 4 * interval, `p95 of lag is ${lag} ms at an interval of ${interval} ms`);
});

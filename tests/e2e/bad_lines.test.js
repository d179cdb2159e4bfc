// What becomes of a player whose line is slow, loses packets, or is cut for a while.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { launch } from './browser.js';
import { internet, makeInternet, ownAddress } from './networks.js';
import { signaling } from './programs.js';
import { startSlowLine } from './slow_line.js';

const port = 40_000;
const pause = (ms) => new Promise((proceed) => setTimeout(proceed, ms));

/** A room on the internet, its render server reached at one port of this address. */
async function makeRoom(t, address = internet) {
  const net = makeInternet(t);
  if (address !== internet) ownAddress(address);
  const room = await signaling(t, { host: internet });
  room.serve('--udp-port', String(port), '--bind', internet, '--public-ip', address);
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
  assert.match(await player.page.locator('#trouble').innerText(), /network is gone|connection lost/i);
  await player.screenshot('network-gone');
  home.mend();
  const { role } = await player.until('back', ({ state }) => state === 'live', 5000).then(() => player.lit(2000));
  assert.equal(role.cube, 1);
  const { places } = await player.knows();
  await player.press('ArrowUp', (known) => known.places[0].y > places[0].y);
  await watcher.until('it watches again', (known) => known.role.cube === 0 && known.role.players === 2);
});

test('50 ms and 1 % loss: the newest map is seldom older than four intervals', async (t) => {
  const slow = '203.0.113.2';
  const { url, net } = await makeRoom(t, slow);
  await startSlowLine(t, {
    from: { address: slow, port },
    to: { address: internet, port },
    delayMs: 50,
    loss: 0.01,
  });
  const home = net.home('cone');
  home.block(`ip daddr ${internet} udp dport ${port}`);
  const player = await (await launch(t, home.prefix)).open(url);
  await player.lit(40_000);

  // Ages are looked at every 5 ms, from when a map has come; intervals are those between maps.
  const measured = player.page.evaluate(
    () =>
      new Promise((settle) => {
        const [ages, intervals] = [[], []];
        let [count, last] = [window.lichtveld.mapsReceived, performance.now()];
        const begin = last;
        const timer = setInterval(() => {
          const now = performance.now();
          if (window.lichtveld.mapsReceived !== count) {
            count = window.lichtveld.mapsReceived;
            intervals.push(now - last);
            last = now;
          }
          ages.push(now - last);
          if (now - begin < 8000) return;
          clearInterval(timer);
          settle({ ages, intervals });
        }, 5);
      }),
  );
  const { keyboard } = player.page;
  for (let i = 0, end = Date.now() + 8500; Date.now() < end; ++i) {
    const key = i % 2 ? 'ArrowRight' : 'ArrowLeft';
    await keyboard.down(key);
    await pause(400);
    await keyboard.up(key);
  }
  const { ages, intervals } = await measured;
  const quantile = (values, share) => [...values].sort((a, b) => a - b)[Math.floor(share * (values.length - 1))];
  const [interval, age] = [quantile(intervals, 0.5), quantile(ages, 0.95)];
  t.diagnostic(`${intervals.length} maps, one every ${interval.toFixed(0)} ms; p95 of age ${age.toFixed(0)} ms`);
  assert.ok(intervals.length > 40, 'maps come');
  assert.ok(age < 4 * interval, `p95 of age is ${age} ms at an interval of ${interval} ms`);
});

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { launch } from './browser.js';
import { signaling } from './programs.js';

test('a page that is too early waits, and joins by itself', async (t) => {
  const { url, serve } = await signaling(t);
  const browser = await launch(t);
  const player = await browser.open(url);
  await player.until('waiting', ({ state }) => state === 'waiting');
  assert.match(await player.page.locator('#trouble').innerText(), /no render server there/i);
  await player.screenshot('waiting');
  serve();
  await player.lit(60_000);
  assert.equal(await player.page.locator('#trouble').isVisible(), false);
});

test('the render server is killed and started again: light again, without a reload', async (t) => {
  const { url, serve } = await signaling(t);
  const server = serve();
  const browser = await launch(t);
  const players = [await browser.open(url), await browser.open(url)];
  for (const player of players) {
    await player.lit(60_000);
    await player.page.evaluate(() => (window.wasNotReloaded = true));
  }

  server.child.kill('SIGKILL');
  await server.exited;
  for (const player of players) await player.until('the loss is noticed', ({ state }) => state !== 'live');
  await players[0].until('waiting', ({ state }) => state === 'waiting');
  await players[0].screenshot('server-killed');

  const before = await Promise.all(players.map((player) => player.knows()));
  serve();
  const after = [];
  for (const [n, player] of players.entries())
    after.push(
      await player.until(
        'lit again',
        ({ state, mapsReceived }) => state === 'live' && mapsReceived > before[n].mapsReceived,
        60_000,
      ),
    );
  for (const player of players) assert.equal(await player.page.evaluate(() => window.wasNotReloaded), true);
  await players[0].until('both play again', ({ role }) => role.players === 2);
  const cubes = await Promise.all(players.map(async (player) => (await player.knows()).role.cube));
  assert.deepEqual(cubes.sort(), [1, 2]);
  await players[0].screenshot('server-back');
});

test('the relay is killed: those who are in play on, and it is found again when it is back', async (t) => {
  const { url, serve, first, relay } = await signaling(t);
  serve();
  const browser = await launch(t);
  const player = await browser.open(url);
  const { places } = await player.lit(60_000);

  first.child.kill('SIGKILL');
  await first.exited;
  await player.press('ArrowUp', (known) => known.places[0].y > places[0].y);
  assert.equal((await player.knows()).state, 'live');
  assert.equal(await player.page.locator('#trouble').isVisible(), false);

  await relay();
  const late = await browser.open(url);
  const { role } = await late.lit(60_000);
  assert.deepEqual([role.cube, role.players], [2, 2]);
  assert.equal((await player.knows()).state, 'live');
});

// Players in browsers of different make.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { launch } from './browser.js';
import { firefoxMissing, openInFirefox } from './firefox.js';
import { changedShare } from './light.js';
import { internet, makeInternet } from './networks.js';
import { signaling } from './programs.js';

/** Steps of a cube, enough for its shadow to be elsewhere. */
const steps = 4;
/** 8-bit steps of a texel that count as a change, and the share of texels that a cube's way has to change. */
const changeTolerance = 4;
const changed = 0.005;

test('a player in Chromium and one in Firefox move in one room', { skip: firefoxMissing() }, async (t) => {
  const net = makeInternet(t);
  const room = await signaling(t, { host: internet });
  room.serve('--udp-port', '40000', '--bind', internet);

  const chromium = await (await launch(t, net.home('cone').prefix)).open(room.url);
  await chromium.lit(40_000);
  const { player: firefox, version } = await openInFirefox(t, room.url);
  await firefox.lit(60_000);
  t.diagnostic(`Chromium and ${version}`);

  const players = [chromium, firefox];
  for (const [cube, mover] of players.entries()) {
    const before = await Promise.all(players.map((player) => player.settledMap()));
    const { role, places } = await mover.knows();
    assert.equal(role.cube, cube + 1, 'cubes in order of joining');
    for (let i = 0; i < steps; ++i) await mover.page.keyboard.press('ArrowUp');
    for (const player of players)
      await player.until(`cube ${cube + 1} has moved`, (known) => known.places[cube].y > places[cube].y + 0.3);
    const after = await Promise.all(players.map((player) => player.settledMap()));
    assert.deepEqual(after[0].data, after[1].data, 'both see the same light');
    for (const [n, map] of after.entries())
      assert.ok(changedShare(before[n], map, changeTolerance) > changed, 'the light has changed with the cube');
  }

  await firefox.screenshot('firefox');
  assert.deepEqual(firefox.thrown, []);
  assert.deepEqual(firefox.errors, []);
});

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { launch } from './browser.js';
import { changedShare, distance, floorChange, mean, pixelAt, texelAt } from './light.js';
import { play, scenePath } from './programs.js';
import { SceneFile } from './scene.js';

const scene = new SceneFile(scenePath);

/** 8-bit steps that a screen pixel may differ from its texel: filtering, 8-bit textures. */
const screenTolerance = 12;
/** Of the wall points looked at, the share that must show their own texel; cubes, blocks and edges hide a few. */
const screenShare = 0.85;
/** 8-bit steps below which a texel counts as unchanged: the exposure and the indirect light change by one or two. */
const changeTolerance = 4;
/** Steps that the cube is moved, and metres that they come to at least: more than its width, less than to the wall. */
const steps = 6;
const wantedMove = 0.85;
/**
 * Metres that the middle of the shadow may be away from the point below its cube. The lamp is the whole ceiling: beside
 * a wall the shadow leans to the wall, and the wall cuts it off.
 */
const shadowTolerance = 0.55;
/** Milliseconds in which a closed tab's cube has to be somebody else's. */
const inheritanceMs = 5000;
/** An orange cube in the room's white light. */
const isOrange = ([red, , blue]) => red > 1.6 * blue;

/** Is every wall's light where it belongs? Looks at texels all over the walls, through the camera. */
async function screenShowsMap(player, picture) {
  const map = await player.map();
  const points = ['left', 'right', 'ceiling', 'back'].flatMap((wall) =>
    // Every fifth texel, away from the chart's edges, where filtering mixes in the gutter.
    scene
      .texels(wall, map.width)
      .filter((_, n) => n % 5 === 2)
      .map((texel) => ({ wall, ...texel })),
  );
  const places = await player.page.evaluate(
    (positions) => positions.map(([x, y, z]) => window.lichtveld.project(x, y, z)),
    points.map(({ position }) => position),
  );
  let seen = 0;
  let right = 0;
  /** @type {Record<string, number[][]>} */
  const colours = {};
  points.forEach((point, n) => {
    const place = places[n];
    // Beneath the status line and the keys there is nothing to see.
    if (!place || place.y < 60 || place.x < 275 || place.y > picture.height - 130) return;
    const pixel = pixelAt(picture, place);
    (colours[point.wall] ??= []).push(pixel);
    seen += 1;
    if (distance(pixel, texelAt(map, point)) <= screenTolerance) right += 1;
  });
  /** The mean of one channel of a wall. */
  const of = (wall, channel) => mean(colours[wall].map((pixel) => pixel[channel]));
  const coloured = of('left', 0) > 1.5 * of('left', 1) && of('right', 1) > 1.2 * of('right', 0);
  const lit = of('ceiling', 1) > of('back', 1) && of('back', 1) > 40;
  return { seen, share: right / seen, coloured, lit };
}

test('a room of two players and a watcher', async (t) => {
  const { url } = await play(t);
  const browser = await launch(t);
  const first = await browser.open(url);
  /** @type {import('./browser.js').Player} */
  let stays;
  const opened = Date.now();
  await first.lit();
  t.diagnostic(`first light after ${Date.now() - opened} ms`);
  const second = await browser.open(url);
  await second.lit();

  await t.test('players get the cubes in order of joining', async () => {
    assert.equal((await first.knows()).role.cube, 1);
    assert.equal((await second.knows()).role.cube, 2);
    const { role } = await first.until('two players', ({ role }) => role.players === 2);
    assert.equal(role.watchers, 0);
  });

  await t.test('both pages see the room, every wall with its own light', async () => {
    for (const [name, player] of Object.entries({ first, second })) {
      await player.settledMap();
      const picture = await player.screenshot(`${name}-player`);
      const { seen, share, coloured, lit } = await screenShowsMap(player, picture);
      t.diagnostic(`${name}: ${(100 * share).toFixed(1)} % of ${seen} points show their texel`);
      assert.ok(seen > 100, `only ${seen} points of the walls are in view`);
      assert.ok(share > screenShare, `only ${share} of the points show their own texel`);
      assert.ok(coloured, 'red on the left, green on the right');
      assert.ok(lit, 'the ceiling glows and the back wall is lit');
    }
  });

  await t.test('an arrow moves the cube and its shadow, on both pages', async () => {
    const players = [first, second];
    const before = await Promise.all(players.map((player) => player.settledMap()));
    const [from] = (await first.knows()).places;
    for (let i = 0; i < steps; ++i) await first.page.keyboard.press('ArrowLeft');
    await first.until('moved', (known) => Math.abs(known.places[0].x - from.x) >= wantedMove);
    const after = await Promise.all(players.map((player) => player.settledMap()));
    const known = await Promise.all(players.map((player) => player.knows()));
    const [to] = known[0].places;
    assert.ok(to.x < from.x && Math.abs(to.y - from.y) < 1e-6, 'ArrowLeft leads along -x');
    assert.deepEqual(known[1].places, known[0].places);
    assert.deepEqual(after[1].data, after[0].data, 'both see the same map');

    const [, , z] = scene.restPlaces()[0];
    const floor = scene.texels('floor', after[0].width);
    const { brighter, darker } = floorChange(before[0], after[0], floor, changeTolerance);
    t.diagnostic(`the cube went from ${from.x} to ${to.x}: ${JSON.stringify({ brighter, darker })}`);
    assert.ok(brighter.texels > 20 && darker.texels > 20, 'the shadow has moved');
    for (const [what, at, x] of [
      ['the old shadow is gone', brighter, from.x],
      ['there is a new one', darker, to.x],
    ])
      assert.ok(
        Math.hypot(at.x - x, at.z - z) < shadowTolerance,
        `${what}, below the cube: ${JSON.stringify(at)}`,
      );
    assert.ok(brighter.x - darker.x > wantedMove / 2, 'the shadow went with the cube');
    const share = changedShare(before[0], after[0], changeTolerance);
    t.diagnostic(`${(100 * share).toFixed(1)} % of the texels changed`);
    assert.ok(share < 0.2, `${share} of the texels changed: more than a shadow`);

    for (const [name, player] of Object.entries({ first, second })) {
      const picture = await player.screenshot(`${name}-player-moved`);
      const [old, now] = await player.page.evaluate(
        (points) => points.map((point) => window.lichtveld.project(...point)),
        [from, to].map(({ x, y }) => [x, y, z]),
      );
      assert.ok(isOrange(pixelAt(picture, now)), `the ${name} page draws the cube at its new place`);
      assert.ok(!isOrange(pixelAt(picture, old)), `and not at the old one`);
    }
  });

  await t.test('/metrics shows what each stage of a map and each pass has taken', async () => {
    const seconds = (text, label, name) =>
      Number(
        new RegExp(`^lichtveld_server_${label}_seconds_total\\{${label}="${name}"\\} (.+)$`, 'm').exec(
          text,
        )?.[1],
      );
    const wanted = [
      ...['input', 'place', 'update', 'encode', 'send'].map((name) => ['stage', name]),
      ...['links', 'direct_light', 'bounces', 'tone_map'].map((name) => ['pass', name]),
    ];
    const text = await (await fetch(`${url}/metrics`)).text();
    for (const [label, name] of wanted)
      assert.ok(seconds(text, label, name) > 0, `${label} ${name} is in\n${text}`);
  });

  await t.test('a watcher cannot move anything, and inherits the cube of a player who leaves', async () => {
    const watcher = await browser.open(url);
    const { role, places } = await watcher.lit();
    assert.deepEqual([role.cube, role.players, role.watchers], [0, 2, 1]);
    await watcher.screenshot('watcher');
    for (let i = 0; i < 5; ++i) await watcher.page.keyboard.press('ArrowLeft');
    await watcher.page.waitForTimeout(700);
    assert.deepEqual((await watcher.knows()).places, places);

    await first.page.close();
    await watcher.until('the cube is inherited', (known) => known.role.cube === 1, inheritanceMs);
    const { role: left } = await second.until('told that one left', (known) => known.role.watchers === 0);
    assert.deepEqual([left.cube, left.players], [2, 2]);
    await watcher.press('ArrowRight', (known) => known.places[0].x > places[0].x);
    await second.until('the heir moves', (known) => known.places[0].x > places[0].x);
    await watcher.screenshot('watcher-inherited');
    stays = watcher;
    assert.deepEqual(watcher.errors, []);
  });

  await t.test('a tab that crashes is missed as soon as one that is closed', async () => {
    const heir = await browser.open(url);
    assert.equal((await heir.lit()).role.cube, 0);
    await second.crash();
    await heir.until('the cube is inherited', (known) => known.role.cube === 2, inheritanceMs);
  });

  await t.test(
    'a page that is left and comes back from the cache plays on without being loaded',
    async () => {
      const player = await browser.open(url);
      const { role } = await player.lit();
      const maps = (await player.knows()).mapsReceived;
      // Headless browsers have no such cache: the events are those that it sends.
      const send = (type) => dispatchEvent(new PageTransitionEvent(type, { persisted: true }));
      await player.page.evaluate(send, 'pagehide');
      await stays.until(
        'one has left',
        ({ role: { watchers } }) => watchers === role.watchers - 1,
        inheritanceMs,
      );
      await player.page.evaluate(send, 'pageshow');
      await player.until('lit again', ({ state, mapsReceived }) => state === 'live' && mapsReceived > maps);
      assert.deepEqual((await player.knows()).role, role);
    },
  );

  assert.deepEqual([...first.errors, ...second.errors], []);
});

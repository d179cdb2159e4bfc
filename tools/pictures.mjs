#!/usr/bin/env node
/**
 * Redraws docs/pictures: the furnished room in its different lights, two browsers in one room, a strip of one while the other moves its cube, what each pass
 * makes of the Cornell room, and the commonest faults of scenes (alone with the word `faults`). Needs the built render
 * server and web client, a Chromium and oiiotool; `./dev pictures` sees to that and to a network in which they meet.
 *
 *   tests/e2e/own_network.sh node tools/pictures.mjs [faults]
 *
 * LICHTVELD names another render server than build/release/lichtveld. What can be seen on a picture is told in
 * docs/algorithm.md; a picture of a light map has two pixels a texel, without filtering.
 */
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, relative } from 'node:path';
import { PNG } from 'pngjs';
import { launch } from '../tests/e2e/browser.js';
import { executable, play, root, roomPath, scenePath } from '../tests/e2e/programs.js';
import { beside } from './pictures/beside.mjs';
import { drawFaults } from './pictures/faults.mjs';

const folder = join(root, 'docs/pictures');
const quality = ['--size', '256', '--psf', '384', '--bounces', '3'];
/** Light on its way down: the blocks' and cubes' shadows fall on the floor. */
const shownPsf = 108;
/** Bytes: pictures travel with every clone. */
const largest = 300_000;
const gap = 12;
/** As `serve` shows it while something moves: with the light of all bounces, each map a step on. */
const moving = ['--size', '256', '--psf', '384'];
/** The furnished room's, of rays. */
const furnished = ['--size', '256', '--psf', '96'];
/** Its front's right upper corner, and how near the cubes are when the lamp stands beside the other one [m]. */
const roomFront = [2.6, 2.8, 2.2];
const besideCube = 0.6;
/** Milliseconds after which a cube that has not moved is held up by a wall, and not by a slow machine. */
const stillMs = 1000;
/** Metres from the left wall at which the strip's pictures are taken, and the part of the page that they show. */
const stripAt = [0, 0.6, 1.2, 1.8];
const stripClip = { x: 100, y: 170, width: 400, height: 380 };

// Without a note of the command line, which would hold this machine's paths.
const oiiotool = (...args) =>
  execFileSync('oiiotool', ['--nosoftwareattrib', ...args.map(String)], {
    stdio: ['ignore', 'inherit', 'inherit'],
  });
const twice = ['--resize:filter=box', '200%', '-d', 'uint8'];
const grey = ['--ch', '0,0,0', '--chnames', 'R,G,B'];
/** Linear light to the screen's 8 bits; `exposure` maps it to 0..1. */
const light = (exposure) => [
  '--ch',
  'R,G,B',
  '--mulc',
  exposure,
  '--colorconvert',
  'linear',
  'sRGB',
  ...twice,
];

/** Throws where all of an image is black: another set of directions has another `shownPsf`. */
function mustShowSomething(image) {
  const stats = execFileSync('oiiotool', ['--stats', image], { encoding: 'utf8' });
  const [, most] = stats.match(/Stats Max: (\S+)/) ?? [];
  if (!(Number(most) > 0)) throw new Error(`${image} is black: choose another shownPsf`);
}

/** The output of every pass, from a bake that writes them down. */
function drawPasses() {
  const work = mkdtempSync(join(tmpdir(), 'lichtveld-pictures-'));
  try {
    const dump = [
      '--dump',
      work,
      '--dump-psf',
      shownPsf,
      '--out',
      join(work, 'E.exr'),
      '--png',
      join(work, 'map.png'),
    ];
    const args = ['bake', scenePath, ...quality, '--abuffer', 'list', ...dump];
    execFileSync(executable, args.map(String), { stdio: 'inherit' });
    const exr = (name) => join(work, `${name}.exr`);
    const png = (name) => join(folder, `${name}.png`);
    const sheet = [`--mosaic:pad=${gap}`, '2x2'];

    // Black outside the charts, where alpha is 0.
    const onCharts = (name, ...scaling) => [
      ...[exr(name), '--ch', 'R,G,B', ...scaling],
      ...[exr('geometry_texture.position'), '--ch', 'A,A,A', '--chnames', 'R,G,B', '--mul', ...twice],
    ];
    oiiotool(
      // The room is 5.6 m wide and deep, 5.488 m high, and its floor is at y = 0.
      ...onCharts('geometry_texture.position', '--addc', '2.8,0,2.8', '--mulc', 1 / 5.6),
      ...onCharts('geometry_texture.normal', '--mulc', 0.5, '--addc', 0.5),
      ...[exr('geometry_texture.albedo'), ...light(1), exr('geometry_texture.emission'), ...light(0.1)],
      ...[...sheet, '-o', png('geometry_texture')],
    );
    // Depth is -1..1 along the direction, 4 where there is nothing: bright is where the light comes from.
    const depth = ['--ch', 'A', '--mulc', -0.4, '--addc', 0.6, ...twice, ...grey];
    const layer = (n) => [exr(`emit_radiance.layer${n}`), ...depth];
    const lamp = [exr('emit_radiance.layer0'), ...light(0.1)];
    oiiotool(...layer(0), ...layer(1), ...layer(2), ...lamp, ...sheet, '-o', png('emit_radiance'));
    mustShowSomething(exr('stencil_routing.psf_irradiance'));
    // One of 384 directions brings this share of a texel's irradiance.
    oiiotool(exr('stencil_routing.psf_irradiance'), ...light(2.5), '-o', png('stencil_routing'));
    oiiotool(exr('blend.total_irradiance'), ...light(0.04), '-o', png('blend'));
    oiiotool(exr('brdf.radiance'), ...light(0.125), '-o', png('brdf'));
    oiiotool(join(work, 'map.png'), ...twice, '-o', png('tone_map'));
  } finally {
    rmSync(work, { recursive: true });
  }
}

/** So many in one room: the first two play. */
async function withPeople(options, scene, viewports, act) {
  const afterwards = [];
  const t = { after: (task) => afterwards.push(task), diagnostic: () => {} };
  try {
    const { url } = await play(t, options, scene);
    const browser = await launch(t);
    const players = [];
    for (const [i, viewport] of viewports.entries()) {
      const player = await browser.open(url, { viewport });
      const cube = i < 2 ? i + 1 : 0;
      await player.until('seated', ({ state, role }) => state === 'live' && role?.cube === cube);
      await player.lit(120_000);
      players.push(player);
    }
    await act(players);
  } finally {
    for (const task of afterwards.reverse()) await task();
  }
}

const twoOfThem = [1, 2].map(() => ({ width: 800, height: 600 }));
const withTwoPlayers = (options, act) => withPeople(options, scenePath, twoOfThem, act);

/** Pictures of one size in rows of three, as a JPEG. */
function sheetOf(pictures, file) {
  const work = mkdtempSync(join(tmpdir(), 'lichtveld-pictures-'));
  try {
    const files = pictures.map((picture, i) => {
      writeFileSync(join(work, `${i}.png`), picture);
      return join(work, `${i}.png`);
    });
    const columns = Math.min(files.length, 3);
    // Those of a sheet are half as large.
    const one = (file) => (files.length > 1 ? [file, '--resize', '50%'] : [file]);
    const mosaic =
      files.length > 1 ? [`--mosaic:pad=${gap / 2}`, `${columns}x${Math.ceil(files.length / columns)}`] : [];
    const jpeg = ['--ch', 'R,G,B', '--compression', 'jpeg:90', '-o', join(folder, file)];
    oiiotool(...files.flatMap(one), ...mosaic, ...jpeg);
  } finally {
    rmSync(work, { recursive: true });
  }
}

/** The furnished room as a watcher sees it, while a player switches its lights and carries one of them. */
async function drawFurnishedRoom() {
  const small = { width: 320, height: 240 };
  const viewports = [small, small, { width: 1200, height: 675 }];
  await withPeople(furnished, roomPath, viewports, async ([player, , watcher]) => {
    await watcher.page.evaluate(() => {
      for (const element of document.querySelectorAll('header, section, nav, #lights'))
        element.style.setProperty('display', 'none', 'important');
    });
    const clip = await watcher.page.evaluate(([x, y, z]) => {
      const [a, b] = [window.lichtveld.project(-x, y, z), window.lichtveld.project(x, 0, z)];
      return { x: a.x, y: a.y, width: b.x - a.x, height: b.y - a.y };
    }, roomFront);
    const shot = async () => {
      await watcher.settledMap(3000);
      return watcher.page.screenshot({ clip });
    };
    const lights = await player.page.evaluate(() => window.lichtveld.lights.map(({ name }) => name));
    const only = async (...on) => {
      for (const [i, name] of lights.entries())
        await player.page.evaluate(
          ([index, pressed]) => {
            const button = document.querySelectorAll('#light-list button')[index];
            if ((button.getAttribute('aria-pressed') === 'true') !== pressed) button.click();
          },
          [i, on.includes(name)],
        );
      const isSo = ({ lights: now }) => now.every(({ name, scale }) => on.includes(name) === scale[0] > 0);
      await watcher.until(`lit by ${on.join(', ')}`, isSo);
      return shot();
    };
    sheetOf([await shot()], 'room.jpg');
    const pictures = [
      await only('sun', 'sky'),
      await only('pendant', 'floor lamp', 'table lamp'),
      await only('pendant'),
      await only('floor lamp'),
      await only('table lamp'),
    ];
    await player.page.keyboard.down('ArrowRight');
    await watcher.until(
      'beside the other cube',
      ({ places }) => places[0].x > places[1].x - besideCube,
      60_000,
    );
    await player.page.keyboard.up('ArrowRight');
    pictures.push(await shot());
    sheetOf(pictures, 'room-lights.jpg');
  });
}

/** What the second player sees while the first holds an arrow: light and shadow go with the cube. */
async function drawMovingCube() {
  await withTwoPlayers(moving, async ([first, second]) => {
    const { keyboard } = first.page;
    const hold = async (key, done) => {
      await keyboard.down(key);
      await second.until(`moved by ${key}`, done);
      await keyboard.up(key);
    };
    const standsStill = () => {
      let [last, since] = ['', 0];
      return ({ places }) => {
        const now = JSON.stringify(places);
        if (now !== last) [last, since] = [now, Date.now()];
        return Date.now() - since > stillMs;
      };
    };
    await hold('ArrowDown', standsStill());
    await hold('ArrowLeft', standsStill());
    await second.page.keyboard.press('?'); // the keys away
    await second.settledMap();
    const from = (await second.knows()).places[0].x;
    const pictures = [];
    await keyboard.down('ArrowRight');
    for (const metres of stripAt) {
      await second.until(`${metres} m away`, ({ places }) => places[0].x >= from + metres);
      pictures.push(PNG.sync.read(await second.page.screenshot({ clip: stripClip })));
    }
    await keyboard.up('ArrowRight');
    writeFileSync(join(folder, 'moving-cube.png'), beside(pictures, gap));
  });
}

/** Two players in one room, after each has moved a cube. */
async function drawTwoBrowsers() {
  await withTwoPlayers(quality, async (players) => {
    for (const [n, player] of players.entries()) {
      const { places, mapsReceived } = await player.lit(120_000);
      await player.page.keyboard.press('ArrowUp');
      // Each place comes with the map that shows it.
      const isLit = (known) => known.places[n].y > places[n].y && known.mapsReceived > mapsReceived;
      for (const each of players) await each.until('it has moved', isLit, 120_000);
    }
    await players[0].page.waitForTimeout(500); // the cubes glide
    const [left, right] = await Promise.all(
      players.map(async ({ page }) => PNG.sync.read(await page.screenshot())),
    );
    writeFileSync(join(folder, 'two-browsers.png'), beside([left, right], gap));
  });
}

/** All but the faults. */
async function drawRooms() {
  await drawFurnishedRoom();
  drawPasses();
  await drawTwoBrowsers();
  await drawMovingCube();
  return [
    'room.jpg',
    'room-lights.jpg',
    'geometry_texture.png',
    'emit_radiance.png',
    'stencil_routing.png',
    'blend.png',
    'brdf.png',
    'tone_map.png',
    'two-browsers.png',
    'moving-cube.png',
  ];
}

const only = process.argv[2];
if (only !== undefined && only !== 'faults')
  throw new Error(`pictures.mjs draws all or faults, not '${only}'`);
mkdirSync(folder, { recursive: true });
const names = only ? [] : await drawRooms();
names.push(...(await drawFaults(join(folder, 'faults'))).map((name) => join('faults', name)));
for (const name of names) {
  const path = join(folder, name);
  const { size } = statSync(path);
  console.log(`${relative(root, path)}: ${Math.ceil(size / 1000)} kB`);
  if (size > largest) throw new Error(`${path} has ${size} bytes, more than ${largest}: make it smaller`);
}

// A scene and its light map in other people's three.js: what examples/light_map.html draws is albedo / pi of E.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { PNG } from 'pngjs';
import { readExr } from '../../tools/exr.mjs';
import { launchBrowser } from './browser.js';
import { GltfFile, box, whole } from './gltf_file.js';
import { lookFrom, openLit, serveFiles } from './lit_page.js';
import { executable, root } from './programs.js';
import { SceneFile } from './scene.js';

const albedos = {
  left: [0.8, 0.3, 0.2],
  right: [0.2, 0.7, 0.3],
  floor: [0.6, 0.6, 0.6],
  back: [0.3, 0.4, 0.8],
};
/** Where in a triangle it is looked, as weights of its corners. */
const places = [
  [0.6, 0.25, 0.15],
  [0.2, 0.6, 0.2],
  [0.15, 0.25, 0.6],
];

/** A room lit from low on its left and back, without TEXCOORD_1; its point light is there for E, not for the page. */
function writeRoom(folder) {
  const file = new GltfFile();
  const [low, high] = [
    [-2, 0, -3],
    [2, 3, 3],
  ];
  const [left, right, floor, ceiling, back, front] = box(low, high, true);
  for (const [name, quad] of Object.entries({ left, right, floor, back }))
    file.add(name, [quad], file.matt(...albedos[name]), { pictures: whole });
  file.add('rest', [ceiling, front], file.matt(0.5, 0.5, 0.5));
  file.add('lamp', box([-1.5, 0.9, -2.6], [-1.1, 1.2, -2.3]), file.shining(8));
  file.use('KHR_lights_punctual');
  file.gltf.extensions = {
    KHR_lights_punctual: { lights: [{ type: 'point', color: [0.5, 0.7, 1], intensity: 3 }] },
  };
  file.node({ translation: [-1, 1, 0.5], extensions: { KHR_lights_punctual: { light: 0 } } });
  return file.write(join(folder, 'room.gltf'));
}

/** E between the middles of texels, as OpenGL has it; v = 0 is the upper edge of row 0. */
function irradianceAt({ width, height, data }, [u, v]) {
  const [x, y] = [u * width - 0.5, v * height - 0.5];
  const [i, j] = [Math.floor(x), Math.floor(y)];
  return [0, 1, 2].map((channel) => {
    const at = (column, row) =>
      data[
        4 * (Math.min(Math.max(row, 0), height - 1) * width + Math.min(Math.max(column, 0), width - 1)) +
          channel
      ];
    const along = (row) => at(i, row) + (x - i) * (at(i + 1, row) - at(i, row));
    return along(j) + (y - j) * (along(j + 1) - along(j));
  });
}

const linear = (byte) => (byte <= 10.3 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4);
const farApart = (a, b) => Math.abs(a - b) > 0.004 + 0.02 * Math.max(a, b);

/** What the page shows at these points of the scene [W m^-2 sr^-1], or nothing where they are out of view. */
async function look(page, points) {
  await page.evaluate(() => (window.view.renderer.toneMapping = 0)); // NoToneMapping
  await lookFrom(page, [0, 1.5, 2.9], [0, 1.3, 0]);
  const pixels = await page.evaluate(
    (points) =>
      points.map((point) => {
        const { camera } = window.view;
        const { x, y } = camera.position
          .clone()
          .set(...point)
          .project(camera);
        return { x: ((x + 1) / 2) * innerWidth, y: ((1 - y) / 2) * innerHeight };
      }),
    points,
  );
  mkdirSync(join(root, 'build/e2e'), { recursive: true });
  const shot = PNG.sync.read(await page.screenshot({ path: join(root, 'build/e2e/light-map.png') }));
  return pixels.map(({ x, y }) => {
    if (!(x > 1 && y > 1 && x < shot.width - 2 && y < shot.height - 2)) return undefined;
    const at = 4 * (Math.floor(y) * shot.width + Math.floor(x));
    return [...shot.data.subarray(at, at + 3)].map(linear);
  });
}

test('three.js shows albedo / pi of the light map, the right way up', async (t) => {
  const folder = mkdtempSync(join(tmpdir(), 'lichtveld-e2e-'));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  const outputs = ['--out', join(folder, 'its light.exr'), '--gltf', join(folder, 'lit.glb')];
  const quality = ['--size', '128', '--psf', '24', '--bounces', '3'];
  execFileSync(executable, ['bake', writeRoom(folder), ...quality, ...outputs]);
  const scene = new SceneFile(join(folder, 'lit.glb'));
  const map = readExr(join(folder, 'its light.exr'));

  const points = Object.keys(albedos).flatMap((name) => {
    const corners = scene.corners(name);
    return [0, 3].flatMap((first) =>
      places.map((weights) => {
        const mean = (of) => weights.reduce((sum, weight, k) => sum + weight * of(corners[first + k]), 0);
        return {
          name,
          position: [0, 1, 2].map((axis) => mean(({ position }) => position[axis])),
          uv: [0, 1].map((axis) => mean(({ uv }) => uv[axis])),
        };
      }),
    );
  });
  const browser = await launchBrowser();
  t.after(() => browser.close());
  const page = await browser.newPage({ viewport: { width: 800, height: 600 } });
  const server = await serveFiles(folder);
  t.after(() => server.close());
  await openLit(page, server.url, 'lit.glb');
  const seen = await look(
    page,
    points.map(({ position }) => position),
  );

  const radiance = ({ name, uv }) =>
    irradianceAt(map, uv).map((e, channel) => (albedos[name][channel] / Math.PI) * e);
  const inView = points.map((point, i) => ({ ...point, seen: seen[i] })).filter((point) => point.seen);
  assert.ok(inView.length >= 16, `${inView.length} points are in view`);
  for (const point of inView) {
    const expected = radiance(point);
    assert.ok(Math.max(...expected) < 1, 'no brighter than a screen');
    assert.ok(
      !expected.some((value, channel) => farApart(value, point.seen[channel])),
      `${point.name} at ${point.position}: ${point.seen} is seen, and ${expected} expected`,
    );
  }
  // Were the map mirrored in either axis, or read by another set of coordinates, most would differ.
  for (const wrong of [
    ([u, v]) => [u, 1 - v],
    ([u, v]) => [1 - u, v],
    ([u, v]) => [v, u],
    () => [0.5, 0.5],
  ]) {
    const differing = inView.filter((point) =>
      radiance({ ...point, uv: wrong(point.uv) }).some((value, c) => farApart(value, point.seen[c])),
    );
    assert.ok(differing.length > inView.length / 2, `${wrong} would show at ${differing.length} points`);
  }
});

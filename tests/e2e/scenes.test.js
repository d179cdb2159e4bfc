// Scenes as people have them: no atlas, a file beside them, holes, glass.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { launch } from './browser.js';
import { GltfFile, box, level } from './gltf_file.js';
import { play } from './programs.js';

const small = ['--size', '64', '--psf', '24', '--bounces', '2'];
/** Writes a .gltf of boxes and squares, without TEXCOORD_1, and its buffer beside it. */
function writeScene(folder) {
  const file = new GltfFile();
  const grey = file.matt(0.5, 0.5, 0.5);
  const hole = {
    pbrMetallicRoughness: { baseColorFactor: [1, 1, 1, 0.2] },
    alphaMode: 'MASK',
    doubleSided: true,
  };
  const glass = { extensions: { KHR_materials_transmission: { transmissionFactor: 1 } } };
  file.add('room', box([-2, 0, -2], [2, 3, 2], true), grey);
  file.add('lamp', [level(2.9, 0.7).reverse()], file.shining(5));
  file.add('net', [level(2.2, 1.9)], file.material(hole));
  file.add('pane', [level(1.5, 1.9)], file.material(glass));
  const extras = { movable: true };
  file.add('first', box([-1.2, 0, -0.3], [-0.6, 0.6, 0.3]), grey, { extras });
  file.add('second', box([0.6, 0, -0.3], [1.2, 0.6, 0.3]), grey, { extras });
  return file.write(join(folder, 'room.gltf'));
}

test('a .gltf without an atlas, with a hole and a pane under its lamp, is lit and drawn', async (t) => {
  const folder = mkdtempSync(join(tmpdir(), 'lichtveld-e2e-'));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  const { url } = await play(t, small, writeScene(folder));
  const browser = await launch(t);
  const player = await browser.open(url);
  const { role, error } = await player.lit(60_000);
  assert.equal(role.cube, 1);
  assert.equal(error, '');
  const { x, y } = await player.page.evaluate(() => window.lichtveld.project(0, 0.02, 0.9));
  const picture = await player.screenshot('no-atlas');
  const [red, green, blue] = picture.data.subarray(4 * (Math.round(y) * picture.width + Math.round(x)));
  assert.ok(
    Math.min(red, green, blue) > 60,
    `the floor is lit through net and pane: ${red} ${green} ${blue}`,
  );
  assert.ok(Math.max(red, green, blue) < 250);
});

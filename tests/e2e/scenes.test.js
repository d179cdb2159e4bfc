// Scenes as people have them: no atlas, a file beside them, holes, glass.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { launch } from './browser.js';
import { play } from './programs.js';

const small = ['--size', '64', '--psf', '24', '--bounces', '2'];
const corners = [
  [0, 0],
  [1, 0],
  [1, 1],
  [0, 1],
];

/** Writes a .gltf of boxes and squares, without TEXCOORD_1, and its buffer beside it. */
function writeScene(folder) {
  const bytes = [];
  const gltf = {
    asset: { version: '2.0' },
    nodes: [],
    meshes: [],
    accessors: [],
    bufferViews: [],
    extensionsUsed: ['KHR_materials_emissive_strength', 'KHR_materials_transmission'],
    materials: [
      { pbrMetallicRoughness: { baseColorFactor: [0.5, 0.5, 0.5, 1] } },
      {
        emissiveFactor: [1, 1, 1],
        extensions: { KHR_materials_emissive_strength: { emissiveStrength: 5 } },
      },
      { pbrMetallicRoughness: { baseColorFactor: [1, 1, 1, 0.2] }, alphaMode: 'MASK', doubleSided: true },
      { extensions: { KHR_materials_transmission: { transmissionFactor: 1 } } },
    ],
  };
  const accessor = (type, componentType, numbers, array) => {
    const buffer = Buffer.from(new array(numbers).buffer);
    const byteOffset = bytes.reduce((sum, { length }) => sum + length, 0);
    bytes.push(buffer);
    gltf.bufferViews.push({ buffer: 0, byteOffset, byteLength: buffer.length });
    const count = numbers.length / { SCALAR: 1, VEC3: 3 }[type];
    gltf.accessors.push({ bufferView: gltf.bufferViews.length - 1, componentType, count, type });
    return gltf.accessors.length - 1;
  };
  const add = (name, quads, material, extras) => {
    const positions = quads.flat(2);
    const indices = quads.flatMap((_, i) => [0, 1, 2, 0, 2, 3].map((k) => 4 * i + k));
    const attributes = { POSITION: accessor('VEC3', 5126, positions, Float32Array) };
    gltf.meshes.push({
      primitives: [{ attributes, indices: accessor('SCALAR', 5125, indices, Uint32Array), material }],
    });
    gltf.nodes.push({ name, mesh: gltf.meshes.length - 1, extras });
  };
  const box = (low, high, inwards) =>
    [0, 1, 2].flatMap((axis) =>
      [0, 1].map((side) => {
        const quad = corners.map(([u, v]) => {
          const point = [];
          point[axis] = side ? high[axis] : low[axis];
          point[(axis + 1) % 3] = u ? high[(axis + 1) % 3] : low[(axis + 1) % 3];
          point[(axis + 2) % 3] = v ? high[(axis + 2) % 3] : low[(axis + 2) % 3];
          return point;
        });
        return (side === 1) !== inwards ? quad : quad.reverse();
      }),
    );
  const level = (y, reach) => [corners.map(([u, v]) => [(2 * v - 1) * reach, y, (2 * u - 1) * reach])];
  add('room', box([-2, 0, -2], [2, 3, 2], true), 0);
  add('lamp', [level(2.9, 0.7)[0].reverse()], 1);
  add('net', level(2.2, 1.9), 2); // nothing but a hole
  add('pane', level(1.5, 1.9), 3);
  add('first', box([-1.2, 0, -0.3], [-0.6, 0.6, 0.3], false), 0, { movable: true });
  add('second', box([0.6, 0, -0.3], [1.2, 0.6, 0.3], false), 0, { movable: true });
  gltf.buffers = [{ uri: 'room.bin', byteLength: bytes.reduce((sum, { length }) => sum + length, 0) }];
  writeFileSync(join(folder, 'room.bin'), Buffer.concat(bytes));
  writeFileSync(join(folder, 'room.gltf'), JSON.stringify(gltf));
  return join(folder, 'room.gltf');
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

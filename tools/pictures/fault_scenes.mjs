// The commonest faults of scenes, each with its cure: small rooms that differ in nothing else. docs/artists.md tells of
// them, beside the pictures that faults.mjs makes.
import { GltfFile, box, level } from '../../tests/e2e/gltf_file.js';

const [low, high] = [
  [-2, 0, -2.5],
  [2, 3, 2.5],
];
const blocks = [
  [
    [-1.4, 0, -1.7],
    [-0.5, 1.5, -0.9],
  ],
  [
    [0.3, 0, -1.2],
    [1.2, 0.7, -0.3],
  ],
];
const colours = { left: [0.7, 0.25, 0.15], right: [0.2, 0.5, 0.25] };
const names = ['left', 'right', 'floor', 'ceiling', 'back', 'front'];

/**
 * A room with two blocks and a lamp below its ceiling.
 * @param {{lamp?: number, wall?: number, without?: string[]}} [options]  lamp: half its side [m], of the same power however
 *   large, 0 for none; wall: what grey surfaces reflect; without: what is left out
 */
function room({ lamp = 0.5, wall = 0.7, without = [] } = {}) {
  const file = new GltfFile();
  const grey = file.matt(wall, wall, wall);
  box(low, high, true).forEach((quad, i) => {
    const colour = colours[names[i]];
    if (!without.includes(names[i])) file.add(names[i], [quad], colour ? file.matt(...colour) : grey);
  });
  if (!without.includes('blocks'))
    for (const [i, [from, to]] of blocks.entries()) file.add(`block ${i + 1}`, box(from, to), grey);
  if (lamp > 0) file.add('lamp', [level(2.95, lamp, [0.4, -0.6]).reverse()], file.shining(3 / lamp ** 2));
  return { file, grey };
}

/** As exporters write what Blender calls a point light of so many watts: in candela. */
function withPoint(watts) {
  const { file } = room({ lamp: 0 });
  file.use('KHR_lights_punctual');
  const intensity = (683 * watts) / (4 * Math.PI);
  file.gltf.extensions = { KHR_lights_punctual: { lights: [{ type: 'point', intensity }] } };
  file.node({ translation: [0.4, 2.4, -0.4], extensions: { KHR_lights_punctual: { light: 0 } } });
  return file;
}

function withBackWall(turned) {
  const { file, grey } = room({ without: ['back'] });
  const back = box(low, high, true)[4];
  file.add('back', [turned ? [...back].reverse() : back], grey);
  return file;
}

/** With so much between walls and ceiling [m], where the sky comes in. */
function withGap(gap) {
  const { file, grey } = room({ without: ['ceiling'], lamp: 0.5 });
  file.add('ceiling', [box(low, [high[0], high[1] + gap, high[2]], true)[3]], grey);
  return file;
}

/** Every face has a cell of a grid for its chart, which it fills but for so much [of the atlas]. */
function withCharts(gap) {
  const file = new GltfFile();
  const grey = file.matt(0.7, 0.7, 0.7);
  const [walls, ...others] = [box(low, high, true), ...blocks.map(([from, to]) => box(from, to))];
  // Faces of blocks, some of them dark, lie between walls.
  const faces = walls.flatMap((wall, i) => [wall, ...others.map((block) => block[i])]);
  faces.push(level(2.95, 0.5, [0.4, -0.6]).reverse());
  faces.forEach((quad, i) => {
    const [left, top] = [(i % 5) / 5 + gap, Math.floor(i / 5) / 4 + gap];
    const [right, bottom] = [left + 1 / 5 - 2 * gap, top + 1 / 4 - 2 * gap];
    const chart = [
      [left, top],
      [right, top],
      [right, bottom],
      [left, bottom],
    ];
    const isLamp = i === faces.length - 1;
    file.add(`face ${i}`, [quad], isLamp ? file.shining(12) : grey, { charts: [chart] });
  });
  return file;
}

function withGround(extras) {
  const { file, grey } = room({ lamp: 0.15 });
  file.add('ground', [level(-0.1, 80)], grey, { extras });
  return file;
}

/** A carpet that lies so far above the floor [m], askew. */
function withCarpet(height) {
  const { file } = room();
  const turned = level(height, 1.1, [0, 0.9]).map(([x, y, z]) => [x + 0.2 * (z - 0.9), y, z - 0.2 * x]);
  file.add('carpet', [turned], file.matt(0.1, 0.15, 0.5));
  return file;
}

/** Blocks whose corners have one normal for all of their faces, as "shade smooth" gives, or each face its own. */
function withNormals(smooth) {
  const { file, grey } = room({ without: ['blocks'] });
  const unit = (vector) => vector.map((x) => x / Math.hypot(...vector));
  for (const [i, [from, to]] of blocks.entries()) {
    const quads = box(from, to);
    const middle = from.map((x, axis) => (x + to[axis]) / 2);
    const normals = quads.map((quad) =>
      quad.map((corner) => unit(corner.map((x, axis) => (x - middle[axis]) / (to[axis] - from[axis])))),
    );
    file.add(`block ${i + 1}`, quads, grey, smooth ? { normals } : {});
  }
  return file;
}

const usual = ['--size', '128'];

/** Each: the file as it is found and as it should be, and the options of `bake` for either. */
export const faults = [
  { name: 'no-light', bad: room({ lamp: 0 }).file, good: room().file },
  { name: 'lumens', bad: withPoint(60), good: withPoint(60), cure: ['--lumens-per-watt', '683'] },
  { name: 'turned-wall', bad: withBackWall(true), good: withBackWall(false) },
  { name: 'gap', bad: withGap(0.05), good: withGap(0), both: [...usual, '--sky', '30,30,30'] },
  { name: 'touching-charts', bad: withCharts(0), good: withCharts(1.5 / 64), both: ['--size', '64'] },
  {
    name: 'few-texels',
    bad: room({ lamp: 0.15 }).file,
    good: room({ lamp: 0.15 }).file,
    both: [],
    worse: ['--size', '24'],
    cure: ['--size', '256'],
  },
  { name: 'large-ground', bad: withGround(), good: withGround({ texels: 0.02 }) },
  { name: 'one-place', bad: withCarpet(0), good: withCarpet(0.01) },
  { name: 'smooth-normals', bad: withNormals(true), good: withNormals(false) },
  { name: 'white-walls', bad: room({ wall: 1 }).file, good: room({ wall: 0.7 }).file },
].map(({ name, bad, good, both = usual, worse = [], cure = [] }) => ({
  name,
  bad: { file: bad, options: [...both, ...worse] },
  good: { file: good, options: [...both, ...cure] },
}));

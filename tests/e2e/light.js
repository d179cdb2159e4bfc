/** Looking at light maps and pictures: plain functions over pixels. */

const luminance = (data, at) => 0.2126 * data[at] + 0.7152 * data[at + 1] + 0.0722 * data[at + 2];

/** The change of one texel's luminance between two maps of one size, in steps of 8 bits; positive is brighter. */
export const change = (before, after, { i, j }) => {
  const at = 4 * (j * before.width + i);
  return luminance(after.data, at) - luminance(before.data, at);
};

export const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;

/**
 * Where a cube's shadow went. Texels of the floor close to below the cube's old and new place are compared with the
 * floor elsewhere.
 * @param {{position: number[], i: number, j: number}[]} floor
 * @param {number[]} from  [x, z] below the old place
 * @param {number[]} to    [x, z] below the new place
 * @param {number} radius  metres
 */
export function shadowChange(before, after, floor, from, to, radius) {
  const near = ({ position: [x, , z] }, place) => Math.hypot(x - place[0], z - place[1]) < radius;
  const changesOf = (texels) => texels.map((texel) => change(before, after, texel));
  return {
    old: mean(changesOf(floor.filter((texel) => near(texel, from)))),
    new: mean(changesOf(floor.filter((texel) => near(texel, to)))),
    elsewhere: mean(changesOf(floor.filter((texel) => !near(texel, from) && !near(texel, to)))),
  };
}

/** The share of all texels that differ by more than `tolerance` in any channel. */
export function changedShare(before, after, tolerance) {
  let changed = 0;
  for (let at = 0; at < before.data.length; at += 4)
    if ([0, 1, 2].some((c) => Math.abs(before.data[at + c] - after.data[at + c]) > tolerance)) changed += 1;
  return changed / (before.data.length / 4);
}

/** RGB of a picture at a place in its own pixels. */
export function pixelAt(picture, { x, y }) {
  const at = 4 * (Math.floor(y) * picture.width + Math.floor(x));
  return [...picture.data.subarray(at, at + 3)];
}

/** RGB of one texel. */
export function texelAt(map, { i, j }) {
  const at = 4 * (j * map.width + i);
  return [...map.data.subarray(at, at + 3)];
}

export const distance = (a, b) => Math.max(...a.map((value, c) => Math.abs(value - b[c])));

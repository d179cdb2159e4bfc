/** Looking at light maps and pictures: plain functions over pixels. */

const luminance = (data, at) => 0.2126 * data[at] + 0.7152 * data[at + 1] + 0.0722 * data[at + 2];

/** The change of one texel's luminance between two maps of one size, in steps of 8 bits; positive is brighter. */
const change = (before, after, { i, j }) => {
  const at = 4 * (j * before.width + i);
  return luminance(after.data, at) - luminance(before.data, at);
};

export const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;

const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];

/** Where these texels are on average, in metres, weighted by how much they changed. */
function centre(changes) {
  const total = changes.reduce((sum, { by }) => sum + Math.abs(by), 0);
  const along = (axis) => changes.reduce((sum, { at, by }) => sum + Math.abs(by) * at[axis], 0) / total;
  return { texels: changes.length, x: along(0), z: along(2) };
}

/**
 * Where a floor has become brighter and where darker. A shadow that moves leaves its old place brighter and makes the
 * new one darker; the median's change is that of the exposure, which adapts to the room, and does not count.
 * @param {{position: number[], i: number, j: number}[]} floor
 * @param {number} tolerance  8-bit steps that are no change
 */
export function floorChange(before, after, floor, tolerance) {
  const exposure = median(floor.map((texel) => change(before, after, texel)));
  const changes = floor.map((texel) => ({
    at: texel.position,
    by: change(before, after, texel) - exposure,
  }));
  return {
    brighter: centre(changes.filter(({ by }) => by > tolerance)),
    darker: centre(changes.filter(({ by }) => by < -tolerance)),
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

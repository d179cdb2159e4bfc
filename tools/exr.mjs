// Reads the .exr files that lichtveld writes: 32-bit float RGBA in scanlines, zip-compressed.
import { readFileSync } from 'node:fs';
import { inflateSync } from 'node:zlib';

const magic = 20000630;
/** Scanlines that are compressed together. */
const linesOfBlock = 16;
const zip = 3;

/** The header's attributes by name, each its bytes, and where the table of the blocks' offsets begins. */
function readHeader(bytes) {
  const attributes = {};
  let at = 8;
  const word = () => {
    const end = bytes.indexOf(0, at);
    const text = bytes.toString('latin1', at, end);
    at = end + 1;
    return text;
  };
  for (let name = word(); name !== ''; name = word()) {
    word(); // its type
    const length = bytes.readUInt32LE(at);
    attributes[name] = bytes.subarray(at + 4, at + 4 + length);
    at += 4 + length;
  }
  return { attributes, table: at };
}

/** Undoes what is done to a block before it is deflated: differences of neighbours, and even bytes before odd ones. */
function restored(packed) {
  for (let i = 1; i < packed.length; ++i) packed[i] = (packed[i - 1] + packed[i] - 128) & 255;
  const half = (packed.length + 1) >> 1;
  return Buffer.from(packed.map((_, i) => packed[(i & 1 ? half : 0) + (i >> 1)]));
}

/**
 * @param {string} path
 * @returns {{width: number, height: number, data: Float32Array}}  RGBA, row 0 as the file has it: on top
 */
export function readExr(path) {
  const bytes = readFileSync(path);
  if (bytes.length < 8 || bytes.readUInt32LE(0) !== magic) throw new Error(`${path} is no .exr file`);
  const { attributes, table } = readHeader(bytes);
  if (attributes.compression[0] !== zip) throw new Error(`${path}: only zip compression is read`);
  if (!attributes.channels.toString('latin1').match(/^A\0[^]{16}B\0[^]{16}G\0[^]{16}R\0/))
    throw new Error(`${path}: only channels R, G, B and A are read`);
  const [left, top, right, bottom] = [0, 4, 8, 12].map((at) => attributes.dataWindow.readInt32LE(at));
  const [width, height] = [right - left + 1, bottom - top + 1];
  const data = new Float32Array(4 * width * height);
  for (let block = 0; block * linesOfBlock < height; ++block) {
    const at = Number(bytes.readBigUInt64LE(table + 8 * block));
    const first = bytes.readInt32LE(at) - top;
    const size = bytes.readUInt32LE(at + 4);
    const lines = Math.min(linesOfBlock, height - first);
    const stored = bytes.subarray(at + 8, at + 8 + size);
    const values = size === 16 * width * lines ? stored : restored(inflateSync(stored));
    for (let line = 0; line < lines; ++line)
      for (let channel = 0; channel < 4; ++channel)
        for (let x = 0; x < width; ++x)
          data[4 * ((first + line) * width + x) + 3 - channel] = values.readFloatLE(
            4 * ((4 * line + channel) * width + x),
          );
  }
  return { width, height, data };
}

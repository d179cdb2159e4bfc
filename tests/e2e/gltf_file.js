import { writeFileSync } from 'node:fs';
import { basename, dirname, join } from 'node:path';

const corners = [
  [0, 0],
  [1, 0],
  [1, 1],
  [0, 1],
];

/**
 * The six faces of a box as corners that go round counter-clockwise, seen from outside or inside: left and right, bottom
 * and top, back and front.
 */
export const box = (low, high, inwards = false) =>
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

/** A square that looks up, `reach` metres from its middle to its sides. */
export const level = (y, reach, [x, z] = [0, 0]) =>
  corners.map(([u, v]) => [x + (2 * v - 1) * reach, y, z + (2 * u - 1) * reach]);

/** A whole picture on a quad: its TEXCOORD_0. */
export const whole = [corners];

/** A scene of quads for tests, whose `gltf` stays open. */
export class GltfFile {
  gltf = {
    asset: { version: '2.0' },
    scene: 0,
    scenes: [{ nodes: [] }],
    nodes: [],
    meshes: [],
    accessors: [],
    bufferViews: [],
    materials: [],
  };
  #bytes = Buffer.alloc(0);

  /** Adds a material; its number. */
  material(material) {
    for (const name of Object.keys(material.extensions ?? {})) this.use(name);
    return this.gltf.materials.push(material) - 1;
  }

  /** A material that reflects so much, and one that shines [W m^-2 sr^-1]. */
  matt(...colour) {
    return this.material({ pbrMetallicRoughness: { baseColorFactor: [...colour, 1] } });
  }
  shining(strength) {
    return this.material({
      pbrMetallicRoughness: { baseColorFactor: [0, 0, 0, 1] },
      emissiveFactor: [1, 1, 1],
      extensions: { KHR_materials_emissive_strength: { emissiveStrength: strength } },
    });
  }

  use(extension) {
    this.gltf.extensionsUsed = [...new Set([...(this.gltf.extensionsUsed ?? []), extension])];
  }

  /**
   * Adds a node of quads. NORMAL as [x, y, z] a corner and TEXCOORD_0 and 1 as [u, v] a corner are left out where they are
   * not given. Its number.
   */
  add(
    name,
    quads,
    material,
    { normals = undefined, pictures = undefined, charts = undefined, ...node } = {},
  ) {
    const attributes = { POSITION: this.#accessor('VEC3', 5126, quads.flat(2), Float32Array) };
    const { gltf } = this;
    Object.assign(gltf.accessors[attributes.POSITION], {
      min: [0, 1, 2].map((axis) => Math.fround(Math.min(...quads.flat().map((point) => point[axis])))),
      max: [0, 1, 2].map((axis) => Math.fround(Math.max(...quads.flat().map((point) => point[axis])))),
    });
    if (normals) attributes.NORMAL = this.#accessor('VEC3', 5126, normals.flat(2), Float32Array);
    for (const [set, uvs] of [pictures ?? charts, charts].entries())
      if (uvs) attributes[`TEXCOORD_${set}`] = this.#accessor('VEC2', 5126, uvs.flat(2), Float32Array);
    const around = quads.flatMap((_, i) => [0, 1, 2, 0, 2, 3].map((k) => 4 * i + k));
    const indices = this.#accessor('SCALAR', 5125, around, Uint32Array);
    const mesh = gltf.meshes.push({ primitives: [{ attributes, indices, material }] }) - 1;
    return this.node({ name, mesh, ...node });
  }

  /** Adds a node to the scene. */
  node(node) {
    const number = this.gltf.nodes.push(node) - 1;
    this.gltf.scenes[0].nodes.push(number);
    return number;
  }

  /** Writes a .gltf, and its buffer as .bin beside it; the path. */
  write(path) {
    const uri = basename(path).replace(/gltf$/, 'bin');
    writeFileSync(join(dirname(path), uri), this.#bytes);
    const buffers = [{ uri, byteLength: this.#bytes.length }];
    writeFileSync(path, JSON.stringify({ ...this.gltf, buffers }));
    return path;
  }

  #accessor(type, componentType, numbers, Numbers) {
    const buffer = Buffer.from(new Numbers(numbers).buffer);
    this.gltf.bufferViews.push({ buffer: 0, byteOffset: this.#bytes.length, byteLength: buffer.length });
    this.#bytes = Buffer.concat([this.#bytes, buffer]);
    const count = numbers.length / { SCALAR: 1, VEC2: 2, VEC3: 3 }[type];
    const bufferView = this.gltf.bufferViews.length - 1;
    return this.gltf.accessors.push({ bufferView, componentType, count, type }) - 1;
  }
}

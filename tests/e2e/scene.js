import { readFileSync, writeFileSync } from 'node:fs';

/** As much of glTF as these tests need: where on the atlas a point of a flat, untransformed wall lies. */
export class SceneFile {
  #json;
  #binary;

  constructor(path) {
    const bytes = readFileSync(path);
    const jsonLength = bytes.readUInt32LE(12);
    this.#json = JSON.parse(bytes.subarray(20, 20 + jsonLength).toString());
    this.#binary = bytes.subarray(20 + jsonLength + 8);
  }

  /** Writes the scene to another file, every surface with this linear reflectance. */
  writeWithAlbedo(path, albedo) {
    const materials = this.#json.materials.map((material) => ({
      ...material,
      pbrMetallicRoughness: { baseColorFactor: [albedo, albedo, albedo, 1] },
    }));
    const json = Buffer.from(JSON.stringify({ ...this.#json, materials }));
    const chunk = (type, bytes, filler) => {
      const padded = Buffer.concat([bytes, Buffer.alloc(-bytes.length & 3, filler)]);
      const header = Buffer.alloc(8);
      header.writeUInt32LE(padded.length);
      header.write(type, 4);
      return Buffer.concat([header, padded]);
    };
    const chunks = Buffer.concat([chunk('JSON', json, ' '), chunk('BIN\0', this.#binary, '\0')]);
    const header = Buffer.from('glTF\x02\0\0\0\0\0\0\0', 'latin1');
    header.writeUInt32LE(header.length + chunks.length, 8);
    writeFileSync(path, Buffer.concat([header, chunks]));
  }

  /** The rest place [x, y, z] of the movable nodes, in the file's order. */
  restPlaces() {
    return this.#json.nodes
      .filter((node) => node.extras?.movable)
      .map((node) => node.translation ?? [0, 0, 0]);
  }

  /**
   * The corners of the triangles of a node: {position: [x, y, z], uv: [u, v]}, three after three.
   * @param {string} name
   */
  corners(name) {
    const node = this.#json.nodes.find((candidate) => candidate.name === name);
    if (!node) throw new Error(`the scene has no node '${name}'`);
    const offset = node.translation ?? [0, 0, 0];
    return this.#json.meshes[node.mesh].primitives.flatMap(({ attributes, indices }) => {
      const positions = this.#read(attributes.POSITION);
      const uvs = this.#read(attributes.TEXCOORD_1);
      return this.#read(indices).map(([i]) => ({
        position: positions[i].map((v, axis) => v + offset[axis]),
        uv: uvs[i],
      }));
    });
  }

  /**
   * Every texel of a node's charts with its place in the scene at rest.
   * @returns {{i: number, j: number, position: number[]}[]}  column, row, [x, y, z]
   */
  texels(name, size) {
    const corners = this.corners(name);
    const found = [];
    for (let k = 0; k < corners.length; k += 3) {
      const [a, b, c] = corners.slice(k, k + 3);
      const [ab, ac] = [b, c].map(({ uv }) => [uv[0] - a.uv[0], uv[1] - a.uv[1]]);
      const area = ab[0] * ac[1] - ab[1] * ac[0];
      for (let j = 0; j < size; ++j)
        for (let i = 0; i < size; ++i) {
          const [u, v] = [(i + 0.5) / size - a.uv[0], (j + 0.5) / size - a.uv[1]];
          const s = (u * ac[1] - v * ac[0]) / area;
          const t = (ab[0] * v - ab[1] * u) / area;
          if (s < 0 || t < 0 || s + t > 1) continue;
          const position = a.position.map(
            (value, axis) => value + s * (b.position[axis] - value) + t * (c.position[axis] - value),
          );
          found.push({ i, j, position });
        }
    }
    return found;
  }

  #read(index) {
    const accessor = this.#json.accessors[index];
    const view = this.#json.bufferViews[accessor.bufferView];
    const width = { SCALAR: 1, VEC2: 2, VEC3: 3 }[accessor.type];
    const [bytes, get] = { 5126: [4, 'readFloatLE'], 5125: [4, 'readUInt32LE'], 5123: [2, 'readUInt16LE'] }[
      accessor.componentType
    ];
    const start = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
    const stride = view.byteStride ?? width * bytes;
    return Array.from({ length: accessor.count }, (_, n) =>
      Array.from({ length: width }, (_, k) => this.#binary[get](start + n * stride + k * bytes)),
    );
  }
}

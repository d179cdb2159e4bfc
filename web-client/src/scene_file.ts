import { sha256 } from '@noble/hashes/sha2';
import { bytesToHex } from '@noble/hashes/utils';
import { DoubleSide, Mesh, type Material, type Object3D } from 'three';
import { GLTFLoader, type GLTF } from 'three/addons/loaders/GLTFLoader.js';

export interface SceneFile {
  readonly root: Object3D;
  /** The nodes with extras.movable, in the file's order. */
  readonly movable: readonly Object3D[];
  /** Of the file's bytes, 64 hex digits. crypto.subtle is missing on plain http, hence the library. */
  readonly sha256: string;
}

/** What replaces the file's materials: the light map says all there is to see. */
export interface Surfaces {
  readonly oneSided: Material;
  readonly twoSided: Material;
}

/** Fetches and reads the scene. */
export async function loadScene(url: string, surfaces: Surfaces): Promise<SceneFile> {
  const response = await fetch(url, { cache: 'no-cache' });
  if (!response.ok) throw new Error(`the scene ${url} could not be loaded: HTTP ${response.status}`);
  const bytes = await response.arrayBuffer();
  const gltf = await new GLTFLoader().parseAsync(bytes, '');
  gltf.scene.traverse((object) => {
    if (!(object instanceof Mesh)) return;
    const { side } = object.material as Material;
    object.material = side === DoubleSide ? surfaces.twoSided : surfaces.oneSided;
    if (!object.geometry.hasAttribute('uv1')) throw new Error(`the mesh ${object.name} has no TEXCOORD_1`);
  });
  return { root: gltf.scene, movable: movableNodes(gltf), sha256: bytesToHex(sha256(new Uint8Array(bytes))) };
}

function movableNodes(gltf: GLTF): Object3D[] {
  const nodes = (gltf.parser.json as { nodes: { extras?: { movable?: unknown } }[] }).nodes;
  const found: { index: number; object: Object3D }[] = [];
  gltf.scene.traverse((object) => {
    const index = gltf.parser.associations.get(object)?.nodes;
    if (
      index !== undefined &&
      nodes[index]?.extras?.movable === true &&
      !found.some((one) => one.index === index)
    )
      found.push({ index, object });
  });
  return found.sort((a, b) => a.index - b.index).map((one) => one.object);
}

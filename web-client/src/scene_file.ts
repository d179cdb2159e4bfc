import { sha256 } from '@noble/hashes/sha2';
import { bytesToHex } from '@noble/hashes/utils';
import { Mesh, Object3D, type Material } from 'three';
import { GLTFLoader, type GLTF } from 'three/addons/loaders/GLTFLoader.js';
import { Backoff } from './backoff';
import type { Surfaces } from './surfaces';

export interface SceneFile {
  readonly root: Object3D;
  /** The outermost nodes with extras.movable, in the file's order. */
  readonly movable: readonly Object3D[];
  /** The first node of that name in the file. */
  node(name: string): Object3D | undefined;
  /** Of the file's bytes, 64 hex digits. crypto.subtle is missing on plain http, hence the library. */
  readonly sha256: string;
}

/** Where the scene is, and the token of the link by which we join where the room wants one. */
export interface SceneSource {
  readonly url: string;
  readonly token?: string | undefined;
}

/** Only with a link's token may the scene be seen; the session says the same, in the relay's words. */
class NotAdmitted extends Error {}

/** Fetches and reads the scene. Rejects with a sentence for people, without its full stop. */
async function loadScene({ url, token }: SceneSource, surfaces: Surfaces): Promise<SceneFile> {
  const headers: Record<string, string> = token ? { Authorization: `Bearer ${token}` } : {};
  const response = await fetch(url, { cache: 'no-cache', headers }).catch(() => {
    throw new Error('the server cannot be reached');
  });
  if (response.status === 401) throw new NotAdmitted();
  if (!response.ok)
    throw new Error(`the server answered HTTP ${response.status} for ${new URL(response.url).pathname}`);
  const bytes = await response.arrayBuffer().catch(() => {
    throw new Error('the scene file broke off on its way');
  });
  try {
    const gltf = await new GLTFLoader().parseAsync(bytes, '');
    prepare(gltf.scene, surfaces);
    return {
      root: gltf.scene,
      movable: movableNodes(gltf),
      node: (name) => namedNode(gltf, name),
      sha256: bytesToHex(sha256(new Uint8Array(bytes))),
    };
  } catch (error) {
    throw new Error(`the scene file cannot be drawn (${reasonOf(error)})`);
  }
}

/**
 * Asks for the scene until it can be had: a server that is away or has a broken file may be restarted. Never settles for
 * somebody who is not admitted.
 * @param onTrouble  called after each attempt that failed, with the milliseconds until the next one
 */
export async function fetchScene(
  source: SceneSource,
  surfaces: Surfaces,
  onTrouble: (reason: string, pause: number) => void,
  backoff = new Backoff(),
): Promise<SceneFile> {
  for (;;) {
    try {
      return await loadScene(source, surfaces);
    } catch (error) {
      if (error instanceof NotAdmitted) return new Promise(() => undefined);
      const pause = backoff.next();
      onTrouble(reasonOf(error), pause);
      await new Promise((resolve) => setTimeout(resolve, pause));
    }
  }
}

const reasonOf = (error: unknown): string => (error instanceof Error ? error.message : String(error));

function prepare(root: Object3D, surfaces: Surfaces): void {
  root.traverse((object) => {
    if (!(object instanceof Mesh)) return;
    object.material = surfaces.like(object.material as Material);
    if (!object.geometry.hasAttribute('uv1')) throw new Error(`the mesh ${object.name} has no TEXCOORD_1`);
  });
}

/** By the file's own names: three.js changes some. */
function namedNode(gltf: GLTF, name: string): Object3D | undefined {
  const nodes = (gltf.parser.json as { nodes?: { name?: unknown }[] }).nodes ?? [];
  const index = nodes.findIndex((node) => node.name === name);
  for (const [object, { nodes: of }] of gltf.parser.associations)
    if (index >= 0 && of === index && object instanceof Object3D) return object;
  return undefined;
}

/** Like the server, only the outermost of each branch: what is inside moves along. */
function movableNodes(gltf: GLTF): Object3D[] {
  const nodes = (gltf.parser.json as { nodes?: { extras?: { movable?: unknown } }[] }).nodes ?? [];
  const found: { index: number; object: Object3D }[] = [];
  const visit = (object: Object3D): void => {
    const index = gltf.parser.associations.get(object)?.nodes;
    if (index !== undefined && nodes[index]?.extras?.movable === true) found.push({ index, object });
    else object.children.forEach(visit);
  };
  visit(gltf.scene);
  return found.sort((a, b) => a.index - b.index).map((one) => one.object);
}

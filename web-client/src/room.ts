import {
  BackSide,
  Box3,
  BoxGeometry,
  Color,
  ColorManagement,
  LinearSRGBColorSpace,
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
  type Object3D,
} from 'three';
import { LightMap } from './light_map';
import { outline } from './outline';
import type { Place } from './protocol';
import type { SceneFile } from './scene_file';
import { Surfaces } from './surfaces';

// Colours go to the screen as they are given, which is sRGB: see LightMap.
ColorManagement.enabled = false;

/** Own cubes' colours in the order of the cubes; the words are used in the hints. */
export const cubeColours = [
  { name: 'orange', css: '#ffb020' },
  { name: 'blue', css: '#5cc8ff' },
] as const;

/** Milliseconds in which a cube covers 63 % of the way to its new place: a step is seen as motion, not as a jump. */
const glideMs = 45;

/**
 * Whether WebGL is drawn by the processor. A picture then costs milliseconds for every 100,000 pixels, and the machine
 * may be the one that computes the light: so edges are not smoothed, and a cube jumps with the map that shows it instead
 * of being drawn on its way there. `failIfMajorPerformanceCaveat` would tell, but Chromium's headless mode denies it.
 */
function drawsInSoftware(): boolean {
  const probe = document.createElement('canvas').getContext('webgl2');
  if (!probe) return false;
  const names = probe.getExtension('WEBGL_debug_renderer_info');
  const name = String(probe.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : probe.RENDERER));
  probe.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|softpipe|basic render/i.test(name);
}

/** What is on the screen: the scene under its light map, drawn only when something has changed. */
export class Room {
  readonly camera = new PerspectiveCamera(50, 1, 0.01, 1000);
  readonly lightMap = new LightMap();
  readonly surfaces = new Surfaces();
  /** Metres: the room's height, by which speeds are measured. */
  height = 1;
  #renderer: WebGLRenderer;
  #scene = new Scene();
  /** Around the room, seen from within alone: around it stays what the page has there. */
  readonly #sky = new Mesh(new BoxGeometry(), new MeshBasicMaterial({ side: BackSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }));
  #movable: readonly Object3D[] = [];
  #file: SceneFile | undefined;
  #targets: (Place | undefined)[] = [];
  #own = 0;
  #outline: ReturnType<typeof outline> | undefined;
  #dirty = true;
  #settle = true;
  readonly #glides: boolean;
  /** Called whenever there is something new to draw. */
  onInvalid = (): void => {};

  /** Throws where WebGL 2 is missing. */
  constructor(canvas: HTMLCanvasElement) {
    const software = drawsInSoftware();
    this.#glides = !software;
    this.#renderer = new WebGLRenderer({ canvas, antialias: !software, powerPreference: 'high-performance' });
    this.#renderer.setPixelRatio(software ? 1 : Math.min(devicePixelRatio, 2));
    this.#renderer.outputColorSpace = LinearSRGBColorSpace;
    this.#scene.background = new Color(0x0b0d10);
    canvas.addEventListener('webglcontextrestored', () => this.invalidate());
  }

  show(file: SceneFile): void {
    this.#scene.add(file.root);
    this.#movable = file.movable;
    this.#file = file;
    const box = new Box3().setFromObject(file.root);
    this.height = box.getSize(new Vector3()).y;
    this.#sky.position.copy(box.getCenter(new Vector3()));
    this.#sky.scale.copy(box.getSize(new Vector3()));
    this.#sky.visible = false;
    this.#scene.add(this.#sky);
    this.#frame(box);
    this.mark(this.#own);
  }

  /** Steps back until the whole room fits, looking in along -z. */
  #frame(box: Box3): void {
    this.resize();
    const size = box.getSize(new Vector3());
    const half = Math.tan((this.camera.fov * Math.PI) / 360);
    const margin = 1.18;
    const distance = (margin * Math.max(size.y, size.x / this.camera.aspect)) / (2 * half);
    const centre = box.getCenter(new Vector3());
    this.camera.position.set(centre.x, centre.y, box.max.z + distance);
    this.camera.rotation.set(0, 0, 0);
    this.camera.near = size.length() / 1000;
    this.camera.far = 20 * size.length() + distance;
    this.camera.updateProjectionMatrix();
  }

  setMap(picture: ImageBitmap): void {
    this.lightMap.show(picture);
    this.surfaces.show(this.lightMap.texture);
    this.invalidate();
  }

  /** What is seen through windows, as #rrggbb; undefined: nothing is. */
  setSky(colour: string | undefined): void {
    this.#sky.visible = colour !== undefined;
    if (colour) this.#sky.material.color.set(colour);
    this.invalidate();
  }

  /** Where the cubes are, in the file's order. */
  setPlaces(places: readonly Place[]): void {
    this.#targets = [...places];
    this.invalidate();
  }

  /** After a pause places are taken at once instead of in a glide across the room. */
  settle(): void {
    this.#settle = true;
  }

  /** Outlines one's own cube: 1 or 2, 0 for none. */
  mark(cube: number): void {
    this.#own = cube;
    this.#outline?.remove();
    this.#outline = undefined;
    const node = this.#movable[cube - 1];
    const colour = cubeColours[cube - 1];
    if (node && colour) this.#outline = outline(node, colour.css);
    this.resize();
  }

  /** Where the label of one's own cube belongs, in CSS pixels; undefined where there is none to see. */
  ownLabelPlace(): { x: number; y: number } | undefined {
    const node = this.#movable[this.#own - 1];
    if (!node) return undefined;
    const box = new Box3().setFromObject(node);
    const centre = box.getCenter(new Vector3());
    return this.project(centre.x, box.max.y, centre.z);
  }

  node(name: string): Object3D | undefined {
    return this.#file?.node(name);
  }

  /** Where one's own cube is, or the eye of somebody who has none. */
  ownPlace(): Vector3 {
    const node = this.#movable[this.#own - 1];
    return node ? new Box3().setFromObject(node).getCenter(new Vector3()) : this.camera.position.clone();
  }

  /** How far away an object is under a point of the page [CSS pixels]; undefined where it is not the first there. */
  hits(object: Object3D, x: number, y: number): number | undefined {
    const { clientWidth, clientHeight } = this.#renderer.domElement;
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2((2 * x) / clientWidth - 1, 1 - (2 * y) / clientHeight), this.camera);
    const first =
      this.#file && ray.intersectObject(this.#file.root, true).find((hit) => hit.object instanceof Mesh);
    for (let node = first?.object; node; node = node.parent ?? undefined)
      if (node === object) return first?.distance;
    return undefined;
  }

  /** From the scene's metres to CSS pixels of the page; undefined behind the camera. */
  project(x: number, y: number, z: number): { x: number; y: number } | undefined {
    this.camera.updateMatrixWorld();
    const point = new Vector3(x, y, z).project(this.camera);
    if (point.z > 1 || point.z < -1) return undefined;
    const canvas = this.#renderer.domElement;
    return { x: ((point.x + 1) / 2) * canvas.clientWidth, y: ((1 - point.y) / 2) * canvas.clientHeight };
  }

  resize(): void {
    const { clientWidth: width, clientHeight: height } = this.#renderer.domElement;
    this.#renderer.setSize(width, height, false);
    this.camera.aspect = width / Math.max(height, 1);
    // On an upright screen the keys lie below the room, which moves up for them.
    if (height > width) this.camera.setViewOffset(width, height, 0, height * 0.1, width, height);
    else this.camera.clearViewOffset();
    this.camera.updateProjectionMatrix();
    this.#outline?.resize(width, height);
    this.invalidate();
  }

  invalidate(): void {
    this.#dirty = true;
    this.onInvalid();
  }

  /** Draws if there is something new; `ms` since the last call. True when it has drawn. */
  draw(ms: number): boolean {
    if (!this.#dirty) return false;
    this.#dirty = this.#moveCubes(this.#settle || !this.#glides ? 1 : 1 - Math.exp(-ms / glideMs));
    if (this.#targets.length > 0) this.#settle = false;
    this.#renderer.render(this.#scene, this.camera);
    if (this.#dirty) this.onInvalid();
    return true;
  }

  /** Moves the cubes by this share of the way to their targets; true while they are not there. */
  #moveCubes(share: number): boolean {
    let moving = false;
    this.#movable.forEach((node, i) => {
      const target = this.#targets[i];
      if (!target || !node.parent) return;
      const world = node.getWorldPosition(new Vector3());
      const [dx, dy] = [target.x - world.x, target.y - world.y];
      const arrived = Math.hypot(dx, dy) < this.height * 1e-4;
      world.set(
        arrived ? target.x : world.x + share * dx,
        arrived ? target.y : world.y + share * dy,
        world.z,
      );
      node.position.copy(node.parent.worldToLocal(world));
      moving ||= !arrived;
    });
    return moving;
  }
}

import { Box3, Vector3, type Object3D } from 'three';
import { formatDimming, type Light, type LightScale } from './protocol';
import type { Room } from './room';

/** Pixels from a light's middle within which a tap means it. */
const tapReach = 40;
/** Milliseconds between two changes of a light that are sent: a slider's are many more. */
const sendEveryMs = 40;

const isOn = (scale: LightScale): boolean => Math.max(...scale) > 0;

/** The lights that switch, as the server has told them last, and what we ask of it. */
export class Lights {
  all: readonly Light[] = [];
  #objects: (Object3D | undefined)[] = [];
  /** What a light that is off is switched on to. */
  readonly #before = new Map<number, LightScale>();
  #wanted = new Map<number, LightScale>();
  #timer: ReturnType<typeof setTimeout> | undefined;

  /** `send` takes a message of the data channel. */
  constructor(
    private readonly room: Room,
    private readonly send: (text: string) => void,
  ) {}

  take(lights: readonly Light[]): void {
    this.all = lights;
    this.#objects = lights.map(({ name }) => this.room.node(name));
    lights.forEach(({ scale }, i) => isOn(scale) && this.#before.set(i, scale));
  }

  toggle(index: number): void {
    const light = this.all[index];
    if (light) this.dim(index, isOn(light.scale) ? [0, 0, 0] : (this.#before.get(index) ?? [1, 1, 1]));
  }

  /** Asks for it at once, or soon where much is asked. */
  dim(index: number, scale: LightScale): void {
    this.#wanted.set(index, scale);
    if (this.#timer === undefined) this.#flush();
  }

  /** The light that is nearest to a place of the scene; undefined where none has a place. */
  nearest(place: Vector3): number | undefined {
    return least(this.#objects.map((object) => object && middleOf(object).distanceTo(place)));
  }

  /** The light under a point of the page [CSS pixels], or close to it. */
  at(x: number, y: number): number | undefined {
    const found = least(
      this.#objects.map((object) => {
        const seen = object && this.room.project(...middleOf(object).toArray());
        return seen && Math.hypot(seen.x - x, seen.y - y);
      }),
      tapReach,
    );
    return found ?? least(this.#objects.map((object) => object && this.room.hits(object, x, y)));
  }

  #flush(): void {
    this.#timer = undefined;
    if (this.#wanted.size === 0) return;
    for (const [index, scale] of this.#wanted) this.send(formatDimming(index, scale));
    this.#wanted = new Map();
    this.#timer = setTimeout(() => this.#flush(), sendEveryMs);
  }
}

const middleOf = (object: Object3D): Vector3 => {
  const box = new Box3().setFromObject(object);
  return box.isEmpty() ? object.getWorldPosition(new Vector3()) : box.getCenter(new Vector3());
};

/** The index of the least of those that are there and at most that. */
function least(values: readonly (number | undefined)[], most = Infinity): number | undefined {
  let found: number | undefined;
  values.forEach((value, i) => {
    if (value !== undefined && value <= most && value < (values[found ?? -1] ?? Infinity)) found = i;
  });
  return found;
}

import { formatNames, recognise, type EncodedMap } from './map_format';

/**
 * Data channel v1, as pure functions over what comes in.
 *
 *   server -> client  binary chunks of one PNG, then the text PNG_TRANSFER_COMPLETE
 *                     text `x1!y1/x2!y2`: where the movable nodes' origins are, in metres, x and y of the scene
 *                     text {"lights":[{"name":"lamp","scale":[1,1,1]}]}, to those who have asked for it
 *   client -> server  text up | down | left | right: one step of one's own cube
 *                     text lights: asks to be told of lights; light N R G B: what the Nth gives, times the scene's
 */
export const channelLabel = 'lichtveld';
export const mapComplete = 'PNG_TRANSFER_COMPLETE';

/** A map of 4096 x 4096 texels compresses to less; more than this is not a map of ours. */
export const maxMapBytes = 16 * 1024 * 1024;

export type Direction = 'up' | 'down' | 'left' | 'right';

/** Metres, in the scene's own axes. */
export interface Place {
  readonly x: number;
  readonly y: number;
}

/** Times what the scene says a light gives: red, green, blue. */
export type LightScale = readonly [number, number, number];

/** One that players switch. */
export interface Light {
  readonly name: string;
  readonly scale: LightScale;
}

export interface Lighting {
  readonly lights: readonly Light[];
  /** What the sky looks like, as #rrggbb; undefined where the room has none. */
  readonly sky?: string;
}

export type Received =
  | ({ readonly kind: 'map' } & EncodedMap)
  | { readonly kind: 'places'; readonly places: readonly Place[] }
  | ({ readonly kind: 'lights' } & Lighting)
  | { readonly kind: 'refused'; readonly reason: string };

const number = String.raw`[-+]?\d{1,9}(?:\.\d{1,50})?`;
const placesPattern = new RegExp(`^${number}!${number}(?:/${number}!${number})*$`, 'i');
const maxPlacesLength = 256;

/** Reads `x1!y1/x2!y2`; undefined for anything else. */
export function parsePlaces(text: string): Place[] | undefined {
  if (text.length > maxPlacesLength || !placesPattern.test(text)) return undefined;
  return text.split('/').map((pair) => {
    const [x = 0, y = 0] = pair.split('!').map(Number);
    return { x, y };
  });
}

/** What asks to be told of lights, now and whenever one changes. */
export const followLights = 'lights';

/** As bright as a light may be made. */
const brightestLight = 16;
const maxLights = 64;
const maxLightsLength = 32 * 1024;

const isLight = (value: unknown): value is Light => {
  const { name, scale } = (value ?? {}) as Partial<Record<keyof Light, unknown>>;
  const good = (channel: unknown) => typeof channel === 'number' && channel >= 0 && channel <= brightestLight;
  return typeof name === 'string' && Array.isArray(scale) && scale.length === 3 && scale.every(good);
};

/** Reads `{"lights":[...],"sky":"#rrggbb"}`; undefined for anything else. */
export function parseLights(text: string): Lighting | undefined {
  if (text.length > maxLightsLength || !text.startsWith('{')) return undefined;
  try {
    const { lights, sky } = JSON.parse(text) as { lights?: unknown; sky?: unknown };
    if (!Array.isArray(lights) || lights.length > maxLights || !lights.every(isLight)) return undefined;
    return typeof sky === 'string' && /^#[0-9a-f]{6}$/.test(sky) ? { lights, sky } : { lights };
  } catch {
    return undefined;
  }
}

/** `index` from 0 on. */
export function formatDimming(index: number, scale: LightScale): string {
  const channels = scale.map((channel) => Math.min(Math.max(channel, 0), brightestLight).toFixed(4));
  return `light ${index + 1} ${channels.join(' ')}`;
}

/** Puts a map together from its chunks, and never holds more than `maxMapBytes`. */
export class Receiver {
  #chunks: ArrayBuffer[] = [];
  #bytes = 0;
  #oversized = false;

  /** Takes one message; undefined while a map is still under way. */
  take(data: string | ArrayBuffer): Received | undefined {
    if (typeof data !== 'string') return this.#takeChunk(data);
    if (data === mapComplete) return this.#finishMap();
    const lighting = parseLights(data);
    if (lighting) return { kind: 'lights', ...lighting };
    const places = parsePlaces(data);
    return places ? { kind: 'places', places } : { kind: 'refused', reason: 'unknown text' };
  }

  #takeChunk(chunk: ArrayBuffer): Received | undefined {
    if (this.#oversized) return undefined;
    if (this.#bytes + chunk.byteLength > maxMapBytes) {
      // The rest of it is skipped until its end, so that the next map starts clean.
      this.#reset();
      this.#oversized = true;
      return { kind: 'refused', reason: `a map larger than ${maxMapBytes} bytes` };
    }
    this.#chunks.push(chunk);
    this.#bytes += chunk.byteLength;
    return undefined;
  }

  #finishMap(): Received | undefined {
    const chunks = this.#chunks;
    const wasOversized = this.#oversized;
    this.#reset();
    if (wasOversized) return undefined;
    const map = recognise(chunks);
    return map ? { kind: 'map', ...map } : { kind: 'refused', reason: `a map that is no ${formatNames}` };
  }

  #reset(): void {
    this.#chunks = [];
    this.#bytes = 0;
    this.#oversized = false;
  }
}

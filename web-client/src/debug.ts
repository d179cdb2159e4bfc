import type { Knowledge } from './knowledge';
import type { Room } from './room';
import type { MapStatistics } from './statistics';

/**
 * `window.lichtveld`: what the page knows, to read in the console and in tests.
 *   state         see State in session.ts
 *   error         what went wrong last, in words; empty if nothing did
 *   mapsReceived  light maps decoded and shown          mapsRefused  dropped: too large, or no picture
 *   role          {cube, players, watchers}, undefined before the server has told
 *   name          what the link calls one, undefined without
 *   places        [{x, y}, ...] of the cubes, in metres, as received last
 *   lights       [{name, scale}, ...] of the lights that switch, as received last
 *   map()         the newest map as ImageData, row 0 where v is 0; undefined before the first
 *   project(x, y, z)  CSS pixels {x, y} of a point of the scene, undefined behind the camera
 */
export function exposeForDebugging(known: Readonly<Knowledge>, statistics: MapStatistics, room: Room): void {
  const lichtveld = {
    get state() {
      return known.state;
    },
    get error() {
      return known.error;
    },
    get role() {
      return known.role;
    },
    get name() {
      return known.name;
    },
    get places() {
      return known.places;
    },
    get lights() {
      return known.lights;
    },
    get mapsReceived() {
      return statistics.received;
    },
    get mapsRefused() {
      return statistics.refused;
    },
    map: () => room.lightMap.pixels(),
    project: (x: number, y: number, z: number) => room.project(x, y, z),
  };
  Object.defineProperty(window, 'lichtveld', { value: Object.freeze(lichtveld) });
}

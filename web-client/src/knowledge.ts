import type { Light, Place } from './protocol';
import type { State } from './session';
import type { Role } from './signaling';

/** What the page knows of the session; read by `window.lichtveld`. */
export interface Knowledge {
  state: State;
  /** What went wrong last, in words. */
  error: string;
  role: Role | undefined;
  /** What one is called, where the link says so. */
  name: string | undefined;
  places: readonly Place[];
  lights: readonly Light[];
}

export const nothingKnown = (): Knowledge => ({
  state: 'connecting',
  error: '',
  role: undefined,
  name: undefined,
  places: [],
  lights: [],
});

import { cubeColours } from './room';
import type { State } from './session';
import type { Role } from './signaling';
import type { MapStatistics } from './statistics';

const element = <T extends HTMLElement = HTMLElement>(id: string): T => {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no #${id}`);
  return found as T;
};

interface Trouble {
  readonly reason: string;
  /** On performance.now()'s clock. */
  readonly retryAt?: number;
}

interface Standing extends Trouble {
  readonly state: State;
}

/** What each state is called, and what somebody who sees it should know. `s` is the seconds until the next attempt. */
const words: Readonly<
  Record<State, (reason: string, s: number) => { short: string; title?: string; text?: string }>
> = {
  connecting: (reason) => ({ short: 'Connecting', ...again(reason) }),
  joining: (reason) => ({ short: 'Joining', ...again(reason) }),
  live: () => ({ short: 'Live' }),
  silent: () => ({ short: 'No word from the render server' }),
  waiting: (reason) => ({
    short: 'Waiting for the render server',
    title: reason ? 'The render server has gone' : 'No render server there',
    text: 'This room gets its light from a server that is not running now. The page joins by itself once it is.',
  }),
  lost: (reason, s) => ({
    short: `Reconnecting in ${s} s`,
    title: 'No connection',
    text: `${sentence(reason)} Trying again in ${s} s.`,
  }),
  offline: (reason, s) => ({
    short: `Offline, trying again in ${s} s`,
    title: 'The network is gone',
    text: `${sentence(reason)} Look at your own connection. Trying again in ${s} s.`,
  }),
  barred: (reason) => ({
    short: 'Not admitted',
    title: 'This room is for those with a link',
    text: sentence(reason),
  }),
  full: (reason, s) => ({
    short: 'Refused',
    title: 'There is no place for you right now',
    text: `${sentence(reason)} Trying again in ${s} s.`,
  }),
  mismatch: () => ({
    short: 'Another scene',
    title: 'The server lights another scene',
    text: 'The light would not fit what this page draws. Start both with the same scene file, then reload.',
  }),
  unsupported: (reason) => ({
    short: 'Not supported',
    title: 'This browser cannot show the room',
    text: sentence(reason),
  }),
};

/** Goes before the session's words: without the scene no light can be shown. */
const withoutScene = (reason: string, s: number) => ({
  short: 'No scene',
  title: 'The room cannot be loaded',
  text: `${sentence(reason)} Trying again in ${s} s.`,
});

/** While an attempt is made: why the one before it failed. */
const again = (reason: string) =>
  reason ? { title: 'No connection', text: `${sentence(reason)} Trying again now.` } : {};

/** What became of one's own cube. */
const lostCube = {
  returned: 'The player whose cube you had has come back. You are watching.',
  away: 'You were away for too long: your cube went to somebody else. You are watching.',
} as const;

const sentence = (text: string): string => `${text.charAt(0).toUpperCase()}${text.slice(1)}.`;

/** Milliseconds for which the hint stays after its keys have first been used. */
const hintLingersMs = 4000;

/** Everything on the page that is not the room itself. */
export class View {
  readonly canvas = element<HTMLCanvasElement>('view');
  readonly arrowButtons = document.querySelectorAll<HTMLButtonElement>('#pad button');
  #standing: Standing = { state: 'connecting', reason: '' };
  #sceneTrouble: Trouble | undefined;
  #relayIsAway = false;
  #hasLight = false;
  #hintTimer: ReturnType<typeof setTimeout> | undefined;

  constructor() {
    element('help').addEventListener('click', () =>
      this.#showHint(element('hint').classList.contains('faded')),
    );
    addEventListener('keydown', ({ key }) => {
      if (key === '?') this.#showHint(element('hint').classList.contains('faded'));
    });
  }

  stand(state: State, detail: Trouble): void {
    this.#standing = { state, ...detail };
    document.body.dataset['state'] = state;
    element('facts').hidden = true;
    this.#write();
  }

  /** Why the scene could not be had; undefined once it is there. */
  missScene(trouble: Trouble | undefined): void {
    this.#sceneTrouble = trouble;
    document.body.toggleAttribute('data-no-scene', trouble !== undefined);
    this.#write();
  }

  /** Whether signaling is away: light still comes, but nobody else can. */
  missRelay(away: boolean): void {
    this.#relayIsAway = away;
    this.#write();
  }

  /** What stands at one's own cube. */
  call(name: string | undefined): void {
    element('own-label').textContent = name ?? 'you';
  }

  /**
   * `changed`: the cube is another one than before, which is worth a hint; `lost`: there was one, and why it has gone:
   * its first player has come back, or one was away oneself.
   */
  showRole(role: Role, changed: boolean, lost?: keyof typeof lostCube): void {
    const colour = cubeColours[role.cube - 1];
    document.body.dataset['role'] = String(role.cube);
    if (colour) element('hint-role').innerHTML = `You move the <b>${colour.name} cube</b>`;
    else if (lost) element('hint-role').textContent = lostCube[lost];
    else if (changed)
      element('hint-role').textContent = 'You are watching. A cube becomes yours when a player leaves.';
    element('fact-players').textContent = String(role.players);
    element('fact-watchers').textContent = String(role.watchers);
    if (changed) this.#showHint(true);
  }

  /** The keys have been used: the hint goes in a while. */
  hintUsed(): void {
    this.#hintTimer ??= setTimeout(() => this.#showHint(false), hintLingersMs);
  }

  placeLabel(place: { x: number; y: number } | undefined): void {
    const label = element('own-label');
    label.hidden = !place;
    if (place) label.style.transform = `translate(${place.x}px, ${place.y}px) translate(-50%, -135%)`;
  }

  /** The numbers, a few times a second. */
  showFacts(statistics: MapStatistics): void {
    const facts = statistics.describe(performance.now());
    element('facts').hidden = !facts || this.#standing.state !== 'live';
    if (facts) {
      if (!this.#hasLight) {
        this.#hasLight = true;
        this.#write();
      }
      element('fact-rate').textContent = facts.rate;
      element('fact-age').textContent = facts.age;
      element('fact-size').textContent = facts.size;
    }
    if ((this.#sceneTrouble ?? this.#standing).retryAt !== undefined) this.#write();
  }

  #write(): void {
    const { state } = this.#standing;
    const { reason, retryAt } = this.#sceneTrouble ?? this.#standing;
    const seconds = Math.max(0, Math.ceil(((retryAt ?? 0) - performance.now()) / 1000));
    const {
      short,
      title = '',
      text = '',
    } = (this.#sceneTrouble ? withoutScene : words[state])(reason, seconds);
    setText('state-text', state === 'live' ? this.#live(short) : short);
    setText('trouble-title', title);
    setText('trouble-text', text);
    element('trouble').hidden = title === '';
  }

  #live(short: string): string {
    if (!this.#hasLight) return 'Waiting for the first light';
    return this.#relayIsAway ? `${short}; signaling is away, trying again` : short;
  }

  #showHint(visible: boolean): void {
    clearTimeout(this.#hintTimer);
    this.#hintTimer = undefined;
    element('hint').classList.toggle('faded', !visible);
    element('help').setAttribute('aria-expanded', String(visible));
  }
}

/** Only on change, or a screen reader would say the same again and again. */
function setText(id: string, text: string): void {
  if (element(id).textContent !== text) element(id).textContent = text;
}

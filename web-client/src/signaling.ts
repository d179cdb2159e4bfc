/** The client's end of the signaling protocol: the messages, and one WebSocket. */

export interface SceneOffer {
  readonly url: string;
  /** Of the file that the render server lights; absent when it did not tell. */
  readonly sha256?: string;
}

/** Which cube is one's own: 0 while one only watches. */
export interface Role {
  readonly cube: 0 | 1 | 2;
  readonly players: number;
  readonly watchers: number;
  /** Of this stay: by it the server knows us again. */
  readonly session?: string;
}

/** Whom the relay greets: oneself, and the render server where one is. */
export interface Welcome {
  readonly type: 'welcome';
  readonly id: string;
  readonly server?: string;
  readonly scene?: SceneOffer;
  /** STUN and TURN servers to find a way with; their credentials are good for a while. */
  readonly iceServers?: RTCIceServer[];
  /** The link's: one only watches; what one is called. */
  readonly seat?: 'watcher';
  readonly name?: string;
}

export type Incoming =
  | Welcome
  | { readonly type: 'waiting' }
  | { readonly type: 'answer'; readonly id: string; readonly description: string }
  | { readonly type: 'candidate'; readonly id: string; readonly candidate: string; readonly mid: string }
  | ({ readonly type: 'role'; readonly id: string } & Role);

export type Outgoing =
  | { readonly id: string; readonly type: 'offer'; readonly description: string; readonly session?: string }
  | { readonly id: string; readonly type: 'rejoin'; readonly session: string }
  | { readonly id: string; readonly type: 'candidate'; readonly candidate: string; readonly mid: string };

const known = new Set(['welcome', 'waiting', 'answer', 'candidate', 'role']);

/** The relay has checked every field; here it is only told apart from messages of a newer relay. */
function parse(text: string): Incoming | undefined {
  const message = JSON.parse(text) as Incoming;
  return known.has(message.type) ? message : undefined;
}

/** Closed by the relay with the reason in words: the room is full ... */
export const tryAgainLater = 1013;
/** ... or the link's token is missing, stale or another room's. */
export const notAdmitted = 4401;

/** Spoken with the relay when a token is shown, which has no other place: a page cannot set a WebSocket's headers. */
const subProtocol = 'lichtveld.signaling';

/** A relay that does not answer in this time [ms] is tried again: the first packets may be lost, and wait long. */
const openTimeMs = 3000;

export interface SignalingEvents {
  onMessage(message: Incoming): void;
  /** Once, however it ended; `reason` is the relay's own words, often empty. */
  onClose(code: number, reason: string): void;
}

export class Signaling {
  readonly #socket: WebSocket;
  readonly #patience: ReturnType<typeof setTimeout>;

  constructor(token: string | undefined, events: SignalingEvents) {
    const url = new URL('/client', location.href);
    url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
    url.hash = '';
    this.#socket = new WebSocket(url, token ? [subProtocol, `lichtveld.join.${token}`] : []);
    this.#patience = setTimeout(() => {
      this.close();
      events.onClose(1006, '');
    }, openTimeMs);
    this.#socket.onopen = () => clearTimeout(this.#patience);
    this.#socket.onmessage = ({ data }) => {
      const message = parse(String(data));
      if (message) events.onMessage(message);
    };
    this.#socket.onclose = ({ code, reason }) => {
      clearTimeout(this.#patience);
      events.onClose(code, reason);
    };
  }

  send(message: Outgoing): void {
    if (this.#socket.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify(message));
  }

  close(): void {
    clearTimeout(this.#patience);
    this.#socket.onmessage = this.#socket.onclose = null;
    this.#socket.close();
  }
}

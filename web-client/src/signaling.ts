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
}

export type Incoming =
  | { readonly type: 'welcome'; readonly id: string; readonly server?: string; readonly scene?: SceneOffer }
  | { readonly type: 'waiting' }
  | { readonly type: 'answer'; readonly id: string; readonly description: string }
  | { readonly type: 'candidate'; readonly id: string; readonly candidate: string; readonly mid: string }
  | ({ readonly type: 'role'; readonly id: string } & Role);

export type Outgoing =
  | { readonly id: string; readonly type: 'offer'; readonly description: string }
  | { readonly id: string; readonly type: 'candidate'; readonly candidate: string; readonly mid: string };

const known = new Set(['welcome', 'waiting', 'answer', 'candidate', 'role']);

/** The relay has checked every field; here it is only told apart from messages of a newer relay. */
function parse(text: string): Incoming | undefined {
  const message = JSON.parse(text) as Incoming;
  return known.has(message.type) ? message : undefined;
}

/** Closed by the relay with the reason in words, e.g. because the room is full. */
export const tryAgainLater = 1013;

export interface SignalingEvents {
  onMessage(message: Incoming): void;
  /** Once, however it ended; `reason` is the relay's own words, often empty. */
  onClose(code: number, reason: string): void;
}

export class Signaling {
  readonly #socket: WebSocket;

  constructor(events: SignalingEvents) {
    const url = new URL('/client', location.href);
    url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
    this.#socket = new WebSocket(url);
    this.#socket.onmessage = ({ data }) => {
      const message = parse(String(data));
      if (message) events.onMessage(message);
    };
    this.#socket.onclose = ({ code, reason }) => events.onClose(code, reason);
  }

  send(message: Outgoing): void {
    if (this.#socket.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify(message));
  }

  close(): void {
    this.#socket.onmessage = this.#socket.onclose = null;
    this.#socket.close();
  }
}

import { Backoff } from './backoff';
import { Peer } from './peer';
import type { Direction } from './protocol';
import { Signaling, tryAgainLater, type Incoming, type Role, type SceneOffer } from './signaling';

/**
 * How things stand, in the order in which a good session passes through them; the last four are where it can go wrong.
 *   connecting  asking the relay            waiting   no render server is there yet
 *   joining     making the data channel     live      the data channel is open
 *   full        the relay has no place      lost      trying again after a pause
 *   mismatch    the server lights another scene file than this page draws
 *   unsupported this browser lacks something that we need
 */
export type State =
  'connecting' | 'waiting' | 'joining' | 'live' | 'full' | 'lost' | 'mismatch' | 'unsupported';

export interface SessionEvents {
  onState(state: State, detail: { reason: string; retryAt?: number }): void;
  onRole(role: Role): void;
  onData(data: string | ArrayBuffer): void;
  /** Is this the scene that we draw? Asked before each join. */
  hasScene(scene: SceneOffer): Promise<boolean>;
}

/** A channel that does not open in this time [ms] will not: ICE takes well below a second on a good network. */
const openTimeMs = 15_000;
/** The server speaks at least once a second: silence of this length [ms] means that it is gone ... */
const silenceMs = 6_000;
/** ... and of this length when signaling has lost it, too. */
const silenceMsWhenGone = 1_800;

/**
 * Keeps us in the room: relay, then render server, and again whenever one of them goes. A data channel that works
 * outlives the relay. Each stay at the relay makes at most one offer to a server, so that no message of an old
 * connection can reach a new one.
 */
export class Session {
  #signaling: Signaling | undefined;
  #greeted = false;
  #server: string | undefined;
  #offeredTo: string | undefined;
  #peer: Peer | undefined;
  #opened = false;
  #heardAt = 0;
  #retryTimer: ReturnType<typeof setTimeout> | undefined;
  #retryAt = 0;
  readonly #backoff = new Backoff();

  constructor(private readonly events: SessionEvents) {
    setInterval(() => this.#watch(), 300);
    this.#connect();
  }

  send(direction: Direction): void {
    this.#peer?.send(direction);
  }

  /** The page goes, perhaps for good: says so to both ends instead of letting them find out by silence. */
  leave(): void {
    this.#dropPeer();
    this.#leaveRelay();
  }

  /** The page is back after `leave`. */
  comeBack(): void {
    this.#backoff.reset();
    this.#connect();
  }

  #connect(): void {
    this.#leaveRelay();
    if (!this.#peer) this.events.onState('connecting', { reason: '' });
    this.#signaling = new Signaling({
      onMessage: (message) => void this.#take(message),
      onClose: (code, reason) => this.#relayClosed(code, reason),
    });
  }

  async #take(message: Incoming): Promise<void> {
    switch (message.type) {
      case 'welcome':
        this.#greeted = true;
        this.#server = message.server;
        if (message.server) await this.#serverCame(message.server, message.scene);
        return;
      case 'waiting':
        this.#server = undefined;
        this.#backoff.reset();
        if (!this.#peer) this.events.onState('waiting', { reason: '' });
        return;
      case 'role':
        if (message.id === this.#peer?.server) this.events.onRole(message);
        return;
      default:
        if (message.id === this.#peer?.server) await this.#peer.take(message);
    }
  }

  async #serverCame(server: string, scene: SceneOffer | undefined): Promise<void> {
    const matches = !scene || (await this.events.hasScene(scene));
    // Much can have happened while the scene was loading.
    if (this.#server !== server || this.#peer) return;
    if (matches) this.#join(server);
    else this.events.onState('mismatch', { reason: '' });
  }

  #join(server: string): void {
    this.#offeredTo = server;
    this.#opened = false;
    this.#heardAt = performance.now();
    this.events.onState('joining', { reason: '' });
    this.#peer = new Peer(server, {
      onSignal: (message) => this.#signaling?.send(message),
      onOpen: () => {
        this.#opened = true;
        this.#heardAt = performance.now();
        this.events.onState('live', { reason: '' });
      },
      onData: (data) => {
        this.#heardAt = performance.now();
        this.#backoff.reset();
        this.events.onData(data);
      },
      onClose: () => this.#lost('the connection to the server was lost'),
    });
  }

  /** Ends a data channel that has gone silent, or that does not open. */
  #watch(): void {
    if (!this.#peer) return;
    const silent = performance.now() - this.#heardAt;
    const gone = this.#greeted && this.#server !== this.#peer.server;
    const allowed = !this.#opened ? openTimeMs : gone ? silenceMsWhenGone : silenceMs;
    if (silent > allowed)
      this.#lost(this.#opened ? 'the server went silent' : 'no direct connection could be made');
  }

  /** The data channel is gone: join again by the shortest way. */
  #lost(reason: string): void {
    this.#dropPeer();
    if (!this.#greeted) {
      // The relay is away as well, and may be about to be asked again.
      if (this.#retryTimer) this.events.onState('lost', { reason, retryAt: this.#retryAt });
      else this.#retry('lost', reason);
    } else if (!this.#server) {
      this.events.onState('waiting', { reason });
    } else if (this.#server !== this.#offeredTo) {
      this.#connect();
    } else {
      this.#retry('lost', reason);
    }
  }

  #relayClosed(code: number, reason: string): void {
    this.#leaveRelay();
    if (code === tryAgainLater) this.#retry('full', reason || 'the room is full');
    else this.#retry('lost', reason || 'the server cannot be reached');
  }

  #retry(state: 'lost' | 'full', reason: string): void {
    this.#leaveRelay();
    const pause = this.#backoff.next();
    this.#retryAt = performance.now() + pause;
    this.#retryTimer = setTimeout(() => this.#connect(), pause);
    // A picture that still comes needs no alarm: the relay is asked again quietly.
    if (!this.#peer) this.events.onState(state, { reason, retryAt: this.#retryAt });
  }

  #leaveRelay(): void {
    clearTimeout(this.#retryTimer);
    this.#retryTimer = undefined;
    this.#signaling?.close();
    this.#signaling = undefined;
    this.#greeted = false;
    this.#server = this.#offeredTo = undefined;
  }

  #dropPeer(): void {
    this.#peer?.close();
    this.#peer = undefined;
    this.#opened = false;
  }
}

import { Backoff } from './backoff';
import { Peer } from './peer';
import {
  Signaling,
  notAdmitted,
  tryAgainLater,
  type Incoming,
  type Role,
  type SceneOffer,
  type Welcome,
} from './signaling';
import { joinToken, StaySecret, tabStorage } from './ticket';

/**
 * How things stand, in the order in which a good session passes through them; the rest are where it can go wrong.
 *   connecting  asking the relay            waiting   no render server is there yet, or not any more
 *   joining     making the data channel     live      the data channel is open, and the server speaks
 *   silent      the data channel is open, but nothing has come for a while
 *   full        the relay has no place      barred    the room is only for those with a link, and ours is none
 *   lost        trying again after a pause  offline   the same, and it is the network that is gone
 *   mismatch    the server lights another scene file than this page draws
 *   unsupported this browser lacks something that we need
 */
export type State =
  | 'connecting'
  | 'waiting'
  | 'joining'
  | 'live'
  | 'silent'
  | 'full'
  | 'barred'
  | 'lost'
  | 'offline'
  | 'mismatch'
  | 'unsupported';

export interface SessionEvents {
  onState(state: State, detail: { reason: string; retryAt?: number }): void;
  /** Whether the relay is there: without it an open channel goes on, but nobody new can join. */
  onRelay(there: boolean): void;
  onGreeting(greeting: Welcome): void;
  onRole(role: Role): void;
  onData(data: string | ArrayBuffer): void;
  /** Is this the scene that we draw? Asked before each join. */
  hasScene(scene: SceneOffer): Promise<boolean>;
}

/** A channel that does not open in this time [ms] will not: ICE takes well below a second on a good network. */
const openTimeMs = 15_000;
/** Seldom the two ends' handshake hangs on a way that was found: then a new try is the shorter way [ms]. */
const handshakeTimeMs = 4_000;
/** The server speaks twice a second: after this time [ms] without a word it is not called live any more ... */
const quietMs = 2_000;
const quietMsWhenGone = 700;
/** ... after this one it is gone ... */
const silenceMs = 6_000;
/** ... and after this one when signaling has lost it, too. */
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
  #iceServers: RTCIceServer[] = [];
  #peer: Peer | undefined;
  #opened = false;
  #quiet = false;
  /** The last channel went silent, and no relay has been reached since. */
  #cutOff = false;
  /** Why the last attempt failed; empty once one has not. */
  #trouble = '';
  #heardAt = 0;
  #retryTimer: ReturnType<typeof setTimeout> | undefined;
  #retryAt = 0;
  readonly #backoff = new Backoff();
  readonly #secret = new StaySecret(tabStorage());

  constructor(private readonly events: SessionEvents) {
    setInterval(() => this.#watch(), 200);
    addEventListener('online', () => this.#retryTimer && this.#connect());
    this.#connect();
  }

  /** A message of the data channel; nothing where none is open. */
  send(text: string): void {
    this.#peer?.send(text);
  }

  /** The page goes, perhaps for good: says so to both ends instead of letting them find out by silence. */
  leave(): void {
    this.#secret.keep();
    this.#dropPeer();
    this.#leaveRelay();
  }

  /** The page is back after `leave`. */
  comeBack(): void {
    this.#secret.takeBack();
    this.#backoff.reset();
    this.#connect();
  }

  #connect(): void {
    this.#leaveRelay();
    if (!this.#peer) this.events.onState('connecting', { reason: this.#trouble });
    this.#signaling = new Signaling(joinToken(location.hash), {
      onMessage: (message) => void this.#take(message),
      onClose: (code, reason) => this.#relayClosed(code, reason),
    });
  }

  async #take(message: Incoming): Promise<void> {
    switch (message.type) {
      case 'welcome':
        return this.#greet(message);
      case 'waiting':
        this.#server = undefined;
        this.#trouble = '';
        this.#backoff.reset();
        if (!this.#peer) this.events.onState('waiting', { reason: '' });
        return;
      case 'role':
        return this.#play(message);
      default:
        if (message.id === this.#peer?.server) await this.#peer.take(message);
    }
  }

  async #greet(welcome: Welcome): Promise<void> {
    this.#greeted = true;
    this.#cutOff = false;
    this.#server = welcome.server;
    this.#iceServers = welcome.iceServers ?? [];
    this.events.onRelay(true);
    this.events.onGreeting(welcome);
    if (welcome.server) await this.#serverCame(welcome.server, welcome.scene);
  }

  async #serverCame(server: string, scene: SceneOffer | undefined): Promise<void> {
    const matches = !scene || (await this.events.hasScene(scene));
    // Much can have happened while the scene was loading.
    if (this.#server !== server) return;
    if (this.#peer) this.#rejoin(server);
    else if (matches) this.#join(server);
    else this.events.onState('mismatch', { reason: '' });
  }

  /** The relay, or the server's line to it, is a new one: the server is told who of its clients we are. */
  #rejoin(server: string): void {
    const session = this.#secret.get();
    if (this.#opened && session && this.#peer?.server !== server)
      this.#signaling?.send({ id: server, type: 'rejoin', session });
  }

  #play(message: Role & { readonly id: string }): void {
    if (!this.#peer) return;
    // After a rejoin the server's id is a new one: that it knows our secret shows that it is still the same.
    if (message.session && message.session === this.#secret.get()) this.#peer.server = message.id;
    if (message.id !== this.#peer.server) return;
    if (message.session) this.#secret.set(message.session);
    this.events.onRole(message);
  }

  #join(server: string): void {
    this.#offeredTo = server;
    this.#opened = this.#quiet = false;
    this.events.onState('joining', { reason: this.#trouble });
    const options = { server, iceServers: this.#iceServers, session: this.#secret.get() };
    this.#peer = new Peer(options, {
      onSignal: (message) => this.#signaling?.send(message),
      onOpen: () => {
        this.#opened = true;
        this.#trouble = '';
        this.#heardAt = performance.now();
        this.events.onState('live', { reason: '' });
      },
      onData: (data) => {
        this.#heardAt = performance.now();
        this.#backoff.reset();
        if (this.#quiet) {
          this.#quiet = false;
          this.events.onState('live', { reason: '' });
        }
        this.events.onData(data);
      },
      onClose: () =>
        this.#lost(this.#opened ? 'the connection to the render server was lost' : this.#whyNotOpen()),
    });
  }

  #whyNotOpen(): string {
    if (this.#peer?.foundWayAt)
      return 'a way to the render server was found, but the connection did not open';
    return this.#peer?.routes.describeFailure() ?? '';
  }

  #mustOpenBy({ madeAt, foundWayAt }: Peer): number {
    return Math.min(madeAt + openTimeMs, (foundWayAt ?? Infinity) + handshakeTimeMs);
  }

  /** Ends a data channel that has gone silent, or that does not open. */
  #watch(): void {
    if (!this.#peer) return;
    const silent = performance.now() - this.#heardAt;
    const gone = this.#greeted && this.#server !== this.#peer.server;
    const quiet = gone ? quietMsWhenGone : quietMs;
    const allowed = gone ? silenceMsWhenGone : silenceMs;
    if (!this.#opened && performance.now() > this.#mustOpenBy(this.#peer)) {
      this.#lost(this.#whyNotOpen());
    } else if (this.#opened && silent > allowed) {
      this.#cutOff = true;
      this.#lost('the render server went silent');
    } else if (this.#opened && silent > quiet && !this.#quiet) {
      this.#quiet = true;
      this.events.onState('silent', { reason: '' });
    }
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
    if (code === notAdmitted) {
      // A token that is no good stays so: another link changes the address, and that loads the page anew. A channel
      // that was opened with it goes on.
      if (this.#peer) this.events.onRelay(false);
      else this.events.onState('barred', { reason });
    } else if (code === tryAgainLater) {
      this.#retry('full', reason || 'the room is full');
    } else if (!navigator.onLine || this.#cutOff) {
      this.#retry('offline', 'neither the render server nor signaling answers');
    } else {
      this.#retry('lost', reason || 'the signaling server cannot be reached');
    }
  }

  #retry(state: 'lost' | 'full' | 'offline', reason: string): void {
    this.#leaveRelay();
    this.#trouble = reason;
    const pause = this.#backoff.next();
    this.#retryAt = performance.now() + pause;
    this.#retryTimer = setTimeout(() => this.#connect(), pause);
    // A picture that still comes needs no alarm: the relay is asked again quietly.
    if (this.#peer) this.events.onRelay(false);
    else this.events.onState(state, { reason, retryAt: this.#retryAt });
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
    this.#opened = this.#quiet = false;
  }
}

import { randomUUID } from 'node:crypto';
import { Connection } from './connection.js';
import { parseMessage } from './messages.js';
import { TokenBucket } from './token_bucket.js';

/**
 * The WebSockets that are in the room, and what passes between them.
 *
 * @typedef {import('ws').WebSocket} WebSocket
 * @typedef {import('./room.js').Delivery} Delivery
 */
export class Relay {
  #room;
  #metrics;
  #gate;
  #limits;
  #log;
  /** @type {Map<string, Connection>} */
  #connections = new Map();

  /**
   * @param {{room: import('./room.js').Room, metrics: import('./metrics.js').Metrics,
   *          gate: import('./address_gate.js').AddressGate<any, any>, limits: import('./limits.js').Limits,
   *          log: (line: string) => void}} options  `log` is told of each peer that comes and goes
   */
  constructor({ room, metrics, gate, limits, log }) {
    this.#room = room;
    this.#metrics = metrics;
    this.#gate = gate;
    this.#limits = limits;
    this.#log = log;
  }

  /**
   * @param {WebSocket} socket
   * @param {string} [sceneSha256]
   */
  acceptServer(socket, sceneSha256) {
    this.#accept(socket, 'server', {
      join: (id) => this.#room.serverJoins(id, sceneSha256),
      leave: () => this.#metrics.showWork(),
      mayOffer: () => true,
    });
  }

  /**
   * @param {WebSocket} socket
   * @param {import('node:stream').Duplex} stream  that it is made of
   * @param {string} address  whose share it takes
   * @param {import('./join_tokens.js').Pass} [pass]  what its token says, where tokens are wanted
   */
  acceptClient(socket, stream, address, pass) {
    this.#gate.joins(address, performance.now());
    const bytes = new TokenBucket(this.#limits.clientByteRate, performance.now());
    stream.on('data', (/** @type {Buffer} */ chunk) => {
      if (stream.destroyed || bytes.take(performance.now(), chunk.length)) return;
      this.#metrics.droppedConnections.inc({ reason: 'bytes' });
      this.#gate.abuses(address, performance.now());
      stream.destroy();
    });
    this.#accept(socket, 'client', {
      join: (id) => this.#room.clientJoins(id, pass),
      leave: () => this.#gate.leaves(address),
      onAbuse: () => this.#gate.abuses(address, performance.now()),
      mayOffer: (connection) => connection.paysOffer() || this.#gate.mayOffer(address, performance.now()),
    });
  }

  /** Called once an interval: ends those who have stopped answering. */
  heartbeat() {
    for (const connection of this.#connections.values()) connection.heartbeat();
  }

  /** The render server is told of STUN and TURN servers anew. */
  renewIceServers() {
    this.#deliver(this.#room.renewIceServers());
  }

  /**
   * All in one go, so that nobody hears of the others' leaving: the render server would end the sessions of clients that
   * it took for gone, and those go on without us.
   */
  close() {
    for (const connection of this.#connections.values())
      connection.close(1001, 'the signaling server is shutting down');
  }

  /**
   * @param {WebSocket} socket
   * @param {'server' | 'client'} role
   * @param {{join: (id: string) => Delivery[], leave: () => void, mayOffer: (connection: Connection) => boolean,
   *          onAbuse?: () => void}} steps
   */
  #accept(socket, role, { join, leave, mayOffer, onAbuse }) {
    const id = randomUUID();
    const connection = new Connection(socket, {
      id,
      role,
      limits: this.#limits,
      metrics: this.#metrics,
      onAbuse,
      onMessage: (text) => {
        const parsed = parseMessage(text, role, this.#limits);
        if ('refused' in parsed) return connection.refuse(parsed.refused);
        if ('work' in parsed) return this.#metrics.showWork(parsed.work);
        const { type } = parsed.message;
        if (type === 'offer' && !mayOffer(connection)) return connection.refuse('offer_rate');
        const relayed = this.#room.relay(id, parsed.message);
        if ('refused' in relayed) return connection.refuse(relayed.refused);
        this.#metrics.relayedMessages.inc({ type });
        this.#metrics.relayedBytes.inc(Buffer.byteLength(text));
        this.#deliver([relayed]);
      },
      onClose: () => {
        this.#connections.delete(id);
        leave();
        this.#deliver(this.#room.leaves(id));
        this.#log(`${role} ${id} left; ${this.#room.clientCount} clients`);
      },
    });
    this.#connections.set(id, connection);
    this.#metrics.connections.inc({ role });
    this.#deliver(join(id));
    this.#log(`${role} ${id} joined; ${this.#room.clientCount} clients`);
  }

  /** @param {Delivery[]} deliveries */
  #deliver(deliveries) {
    for (const { to, message } of deliveries) {
      const connection = this.#connections.get(to);
      if (message.type === 'welcome' && message.server) connection?.owesOffer();
      connection?.send(message);
    }
  }
}

import { TokenBucket } from './token_bucket.js';

/**
 * One accepted WebSocket: its rate, its refusals, its heartbeat, its send buffer. Whatever a peer does wrong is counted
 * and, when it goes on, ends this connection alone.
 */
export class Connection {
  #socket;
  #limits;
  #metrics;
  #onAbuse;
  #bucket;
  #refusals = 0;
  #unansweredPings = 0;
  #owedOffers = 0;

  /**
   * @param {import('ws').WebSocket} socket
   * @param {{id: string, role: 'server' | 'client', limits: import('./limits.js').Limits,
   *          metrics: import('./metrics.js').Metrics, onMessage: (text: string) => void, onClose: () => void,
   *          onAbuse?: () => void}} options  `onAbuse`: it is ended for what it sent
   */
  constructor(socket, { id, role, limits, metrics, onMessage, onClose, onAbuse = () => {} }) {
    this.id = id;
    this.role = role;
    this.#socket = socket;
    this.#limits = limits;
    this.#metrics = metrics;
    this.#onAbuse = onAbuse;
    this.#bucket = new TokenBucket(
      role === 'server' ? limits.serverRate : limits.clientRate,
      performance.now(),
    );

    socket.on('pong', () => {
      this.#unansweredPings = 0;
      this.#isTooMuch();
    });
    socket.on('ping', () => this.#isTooMuch());
    socket.on('close', onClose);
    // ws closes a broken connection by itself, with the code that fits, and would then wait for half a minute.
    socket.on('error', (error) => {
      const tooLarge =
        /** @type {NodeJS.ErrnoException} */ (error).code === 'WS_ERR_UNSUPPORTED_MESSAGE_LENGTH';
      metrics.droppedConnections.inc({ reason: tooLarge ? 'oversized' : 'protocol_error' });
      this.#endsSoon();
      onAbuse();
    });
    socket.on('message', (data, isBinary) => {
      if (this.#isTooMuch()) return;
      if (isBinary) this.refuse('binary');
      else onMessage(data.toString());
    });
  }

  /**
   * Counts a refused message; too many of them end the connection.
   * @param {string} reason
   */
  refuse(reason) {
    this.#metrics.refusedMessages.inc({ reason });
    // Peers that leave while messages to them are under way are nobody's fault.
    if (reason === 'no_such_peer') return;
    this.#refusals += 1;
    if (this.#refusals >= this.#limits.maxRefusals)
      this.close(1008, `too many refused messages, the last one: ${reason}`);
  }

  /** @param {object} message */
  send(message) {
    if (this.#socket.readyState !== this.#socket.OPEN) return;
    this.#socket.send(JSON.stringify(message));
    if (this.#socket.bufferedAmount > this.#limits.maxBufferedBytes) this.#drop('does_not_read');
  }

  /** It has been told of a render server, and will make it an offer. */
  owesOffer() {
    this.#owedOffers = 1;
  }

  /** @returns {boolean} whether an offer that comes now is the one that it owed */
  paysOffer() {
    this.#owedOffers -= 1;
    if (this.#owedOffers >= 0) return true;
    this.#owedOffers = 0;
    return false;
  }

  /** Called once an interval: ends a peer that has stopped answering. */
  heartbeat() {
    if (this.#unansweredPings >= this.#limits.maxMissedPings) return this.#drop('silent');
    this.#unansweredPings += 1;
    this.#socket.ping();
  }

  /**
   * @param {number} code  of RFC 6455, section 7.4
   * @param {string} reason  for people
   */
  close(code, reason) {
    if (this.#socket.readyState !== this.#socket.OPEN) return;
    this.#socket.close(code, reason);
    this.#endsSoon();
    if (code !== 1008) return;
    this.#metrics.droppedConnections.inc({ reason: 'refusals' });
    this.#socket.pause(); // what else it sends is not even parsed
    this.#onAbuse();
  }

  /** A peer that ignores the close would otherwise keep its place in the room. */
  #endsSoon() {
    setTimeout(() => this.#socket.terminate(), this.#limits.closeTimeoutMs).unref();
  }

  /** Counts what has come. @returns {boolean} whether it is to be ignored */
  #isTooMuch() {
    if (this.#socket.readyState !== this.#socket.OPEN) return true;
    if (this.#bucket.take(performance.now())) return false;
    this.refuse('flood');
    return true;
  }

  /** @param {string} reason */
  #drop(reason) {
    this.#metrics.droppedConnections.inc({ reason });
    this.#socket.terminate();
  }
}

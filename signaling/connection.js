import { TokenBucket } from './token_bucket.js';

/**
 * One accepted WebSocket: its rate, its refusals, its heartbeat, its send buffer. Whatever a peer does wrong is counted
 * and, when it goes on, ends this connection alone.
 */
export class Connection {
  #socket;
  #limits;
  #metrics;
  #bucket;
  #refusals = 0;
  #unansweredPings = 0;

  /**
   * @param {import('ws').WebSocket} socket
   * @param {{id: string, role: 'server' | 'client', limits: import('./limits.js').Limits,
   *          metrics: import('./metrics.js').Metrics, onMessage: (text: string) => void, onClose: () => void}} options
   */
  constructor(socket, { id, role, limits, metrics, onMessage, onClose }) {
    this.id = id;
    this.role = role;
    this.#socket = socket;
    this.#limits = limits;
    this.#metrics = metrics;
    this.#bucket = new TokenBucket(
      role === 'server' ? limits.serverRate : limits.clientRate,
      performance.now(),
    );

    socket.on('pong', () => (this.#unansweredPings = 0));
    socket.on('close', onClose);
    // ws closes a broken connection by itself, with the code that fits; what is left to do is to count it.
    socket.on('error', (error) => {
      const tooLarge =
        /** @type {NodeJS.ErrnoException} */ (error).code === 'WS_ERR_UNSUPPORTED_MESSAGE_LENGTH';
      metrics.droppedConnections.inc({ reason: tooLarge ? 'oversized' : 'protocol_error' });
    });
    socket.on('message', (data, isBinary) => {
      if (socket.readyState !== socket.OPEN) return;
      if (!this.#bucket.take(performance.now())) this.refuse('flood');
      else if (isBinary) this.refuse('binary');
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
    if (code === 1008) this.#metrics.droppedConnections.inc({ reason: 'refusals' });
    this.#socket.close(code, reason);
    // A peer that ignores the close would otherwise keep its place in the room.
    setTimeout(() => this.#socket.terminate(), this.#limits.closeTimeoutMs).unref();
  }

  /** @param {string} reason */
  #drop(reason) {
    this.#metrics.droppedConnections.inc({ reason });
    this.#socket.terminate();
  }
}

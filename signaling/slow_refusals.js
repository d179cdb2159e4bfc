/**
 * Who is refused at the door learns it a moment later. Refused at once it would be back at once, thousands of times a
 * second, and everybody else would stand in line behind it.
 */
export class SlowRefusals {
  #delayMs;
  #max;
  /** In the order in which they came. @type {Set<import('node:net').Socket>} */
  #held = new Set();

  /** @param {import('./limits.js').Limits} limits */
  constructor({ refusalDelayMs, maxHeldRefusals }) {
    this.#delayMs = refusalDelayMs;
    this.#max = maxHeldRefusals;
  }

  /** @param {import('node:net').Socket} socket  of which nothing is read */
  refuse(socket) {
    const [oldest] = this.#held;
    if (oldest && this.#held.size >= this.#max) this.#end(oldest);
    this.#held.add(socket);
    const timer = setTimeout(() => this.#end(socket), this.#delayMs).unref();
    socket.on('error', () => {});
    socket.once('close', () => {
      clearTimeout(timer);
      this.#held.delete(socket);
    });
  }

  close() {
    for (const socket of this.#held) this.#end(socket);
  }

  /** Nothing of it stays, not even in the system's tables. @param {import('node:net').Socket} socket */
  #end(socket) {
    this.#held.delete(socket);
    socket.resetAndDestroy();
  }
}

/**
 * Waiting times between attempts: they double from 0.5 s to 8 s, each shortened by up to half at random, so that a
 * room full of browsers does not come back in one instant.
 */
export class Backoff {
  #attempt = 0;

  constructor(private readonly random: () => number = Math.random) {}

  /** Milliseconds to wait before the next attempt. */
  next(): number {
    const ceiling = Math.min(8000, 500 * 2 ** this.#attempt);
    this.#attempt += 1;
    return ceiling * (1 - this.random() / 2);
  }

  /** After a success. */
  reset(): void {
    this.#attempt = 0;
  }
}

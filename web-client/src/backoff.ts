/**
 * Waiting times between attempts: 0.5 s, 1 s, then 2 s, so that a network that was gone for some seconds is found again
 * soon; after ten attempts 8 s. Each is shortened by up to half at random, so that a room full of browsers does not come
 * back in one instant.
 */
export class Backoff {
  #attempt = 0;

  constructor(private readonly random: () => number = Math.random) {}

  /** Milliseconds to wait before the next attempt. */
  next(): number {
    const ceiling = this.#attempt < 10 ? Math.min(2000, 500 * 2 ** this.#attempt) : 8000;
    this.#attempt += 1;
    return ceiling * (1 - this.random() / 2);
  }

  /** After a success. */
  reset(): void {
    this.#attempt = 0;
  }
}

/** A token bucket: lets `burst` through at once and `perSecond` in the long run. */
export class TokenBucket {
  #tokens;
  #last;
  #rate;

  /**
   * @param {import('./limits.js').Rate} rate
   * @param {number} now  milliseconds of any steady clock
   */
  constructor(rate, now) {
    this.#rate = rate;
    this.#tokens = rate.burst;
    this.#last = now;
  }

  /**
   * Takes one token, or several.
   * @param {number} now  milliseconds, same clock as the constructor's
   * @param {number} [count]
   * @returns {boolean} false when there are fewer left
   */
  take(now, count = 1) {
    this.#refill(now);
    if (this.#tokens < count) return false;
    this.#tokens -= count;
    return true;
  }

  /**
   * Takes some, there or not: what is missing has to be refilled first. Half of a burst may be owed.
   * @param {number} count
   * @param {number} now
   */
  owe(count, now) {
    this.#refill(now);
    this.#tokens = Math.max(-this.#rate.burst / 2, this.#tokens - count);
  }

  /**
   * Is it as good as new?
   * @param {number} now
   */
  isFull(now) {
    this.#refill(now);
    return this.#tokens >= this.#rate.burst;
  }

  /** @param {number} now */
  #refill(now) {
    const refilled = ((now - this.#last) / 1000) * this.#rate.perSecond;
    this.#tokens = Math.min(this.#rate.burst, this.#tokens + refilled);
    this.#last = now;
  }
}

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
   * Takes one token.
   * @param {number} now  milliseconds, same clock as the constructor's
   * @returns {boolean} false when there is none left
   */
  take(now) {
    this.#tokens = Math.min(
      this.#rate.burst,
      this.#tokens + ((now - this.#last) / 1000) * this.#rate.perSecond,
    );
    this.#last = now;
    if (this.#tokens < 1) return false;
    this.#tokens -= 1;
    return true;
  }
}

import { TokenBucket } from './token_bucket.js';

/**
 * What is refused or ended by us is counted by reason, and told: the first of a reason at once, then one line an interval
 * with how many there were. An attack fills no disk.
 */
export class Refusals {
  #log;
  #intervalMs;
  /** @type {Map<string, {more: number, example: string, timer: NodeJS.Timeout}>} */
  #recent = new Map();

  /**
   * @param {(line: string) => void} log
   * @param {import('./limits.js').Limits} limits
   */
  constructor(log, { logIntervalMs }) {
    this.#log = log;
    this.#intervalMs = logIntervalMs;
  }

  /**
   * @param {import('prom-client').Counter} counter  with the label `reason`
   * @param {string} reason  one of a few
   * @param {string} address  whose it was
   * @param {string} text  for people, without anything secret
   */
  note(counter, reason, address, text) {
    counter.inc({ reason });
    const recent = this.#recent.get(reason);
    if (recent) {
      recent.more += 1;
      recent.example = address;
      return;
    }
    this.#log(`${text} (${reason}, ${address})`);
    const timer = setInterval(() => this.#sum(reason), this.#intervalMs);
    this.#recent.set(reason, { more: 0, example: address, timer: timer.unref() });
  }

  close() {
    for (const { timer } of this.#recent.values()) clearInterval(timer);
    this.#recent.clear();
  }

  /** @param {string} reason */
  #sum(reason) {
    const recent = this.#recent.get(reason);
    if (!recent) return;
    if (recent.more === 0) {
      clearInterval(recent.timer);
      this.#recent.delete(reason);
      return;
    }
    this.#log(
      `${recent.more} more in ${this.#intervalMs / 1000} s (${reason}, the last one ${recent.example})`,
    );
    recent.more = 0;
  }
}

/**
 * Lines about single peers, as long as they are few.
 * @param {(line: string) => void} log
 * @param {import('./limits.js').Limits} limits
 * @returns {(line: string) => void}
 */
export function limitedLog(log, { logRate }) {
  const bucket = new TokenBucket(logRate, performance.now());
  let left = 0;
  return (line) => {
    if (!bucket.take(performance.now())) return void (left += 1);
    log(left === 0 ? line : `${line} (and ${left} such lines before it)`);
    left = 0;
  };
}

/** What the status line says of the maps: how often they come, how old the newest one is, how large. */
export class MapStatistics {
  received = 0;
  refused = 0;
  #times: number[] = [];
  #lastAt = 0;
  #bytes = 0;
  #size = '';

  /** A map has been decoded. `now` in milliseconds. */
  count(bytes: number, width: number, height: number, now: number): void {
    this.received += 1;
    this.#bytes = bytes;
    this.#size = `${width} × ${height}`;
    this.#lastAt = now;
    this.#times.push(now);
    this.#forget(now);
  }

  /** After a break the rate starts afresh. */
  restart(): void {
    this.#times = [];
  }

  /** Maps a second over the last five seconds. */
  rate(now: number): number {
    this.#forget(now);
    const first = this.#times[0];
    if (first === undefined || this.#times.length < 2) return 0;
    return (this.#times.length - 1) / Math.max((now - first) / 1000, 0.001);
  }

  describe(now: number): { rate: string; age: string; size: string } | undefined {
    if (this.received === 0) return undefined;
    const seconds = (now - this.#lastAt) / 1000;
    return {
      rate: this.rate(now).toFixed(1),
      age: `${seconds.toFixed(seconds < 10 ? 1 : 0)} s`,
      size: `${this.#size}, ${Math.max(1, Math.round(this.#bytes / 1024))} KB`,
    };
  }

  #forget(now: number): void {
    while (this.#times[0] !== undefined && now - this.#times[0] > 5000) this.#times.shift();
  }
}

/** Milliseconds that a frame counts for at most: what a page that was stopped has missed is not made up for. */
const longestFrameMs = 100;
/** Milliseconds that the first frame after a pause counts for. */
const usualFrameMs = 20;

/** Frames are asked for only while there is something new to draw. */
export class Frames {
  #last = 0;
  #asked = false;

  /** `draw` gets the milliseconds since the frame before, and may ask for the next one. */
  constructor(private readonly draw: (ms: number) => void) {}

  ask(): void {
    if (this.#asked) return;
    this.#asked = true;
    this.#last = Math.max(this.#last, performance.now() - usualFrameMs);
    requestAnimationFrame((now) => this.#frame(now));
  }

  #frame(now: number): void {
    this.#asked = false;
    const ms = Math.min(Math.max(0, now - this.#last), longestFrameMs);
    this.#last = now;
    this.draw(ms);
  }
}

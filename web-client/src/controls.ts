import { Flight } from './flight';
import type { Direction } from './protocol';
import type { Room } from './room';

const arrows: Readonly<Record<string, Direction>> = {
  ArrowUp: 'up',
  ArrowDown: 'down',
  ArrowLeft: 'left',
  ArrowRight: 'right',
};

/** By place on the keyboard, so that WASD lies well on every layout: right, up, ahead. */
const flightKeys: Readonly<Record<string, readonly [number, number, number]>> = {
  KeyW: [0, 0, 1],
  KeyS: [0, 0, -1],
  KeyA: [-1, 0, 0],
  KeyD: [1, 0, 0],
  KeyE: [0, 1, 0],
  Space: [0, 1, 0],
  KeyQ: [0, -1, 0],
  ShiftLeft: [0, -1, 0],
};

/** Steps a second while an arrow is held. */
const stepsPerSecond = 15;
/** Room heights a second. */
const flightSpeed = 0.6;
/** A press that moves less than this [pixels] is a click. */
const clickSlop = 4;

export interface ControlEvents {
  onStep(direction: Direction): void;
  /** Key L: the nearest light. */
  onSwitch(): void;
  /** A click or a tap there [CSS pixels]; true if it meant something. */
  onTap(x: number, y: number): boolean;
  /** Something was used: the hint has done its work. */
  onUse(): void;
}

/** Keys, mouse and fingers: arrows move one's own cube, the rest flies the camera. */
export class Controls {
  readonly #flight: Flight;
  readonly #held = new Set<string>();
  readonly #pointers = new Map<number, { x: number; y: number }>();
  #travel = 0;
  #stepping: { direction: Direction; timer: ReturnType<typeof setInterval> } | undefined;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly room: Room,
    private readonly events: ControlEvents,
    arrowButtons: Iterable<HTMLButtonElement>,
  ) {
    this.#flight = new Flight(room.camera);
    addEventListener('keydown', (event) => this.#keyDown(event));
    addEventListener('keyup', ({ code }) => this.#keyUp(code));
    addEventListener('blur', () => this.#releaseAll());
    document.addEventListener('visibilitychange', () => this.#releaseAll());
    for (const button of arrowButtons) this.#wireButton(button);
    canvas.addEventListener('pointerdown', (event) => this.#pointerDown(event));
    canvas.addEventListener('pointermove', (event) => this.#pointerMove(event));
    canvas.addEventListener('pointerup', (event) => this.#pointerUp(event));
    canvas.addEventListener('pointercancel', ({ pointerId }) => this.#pointers.delete(pointerId));
    canvas.addEventListener('wheel', (event) => this.#wheel(event), { passive: false });
  }

  /** Flies on while keys are held; `ms` since the last call. */
  advance(ms: number): void {
    const distance = (flightSpeed * this.room.height * ms) / 1000;
    for (const code of this.#held) {
      const [right, up, ahead] = flightKeys[code] ?? [0, 0, 0];
      this.#flight.move(right * distance, up * distance, ahead * distance);
      this.room.invalidate();
    }
  }

  #keyDown(event: KeyboardEvent): void {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const direction = arrows[event.code];
    if (direction) {
      event.preventDefault();
      if (!event.repeat) this.#startSteps(direction);
    } else if (event.code === 'KeyL') {
      if (!event.repeat) this.events.onSwitch();
      this.events.onUse();
    } else if (
      event.code in flightKeys &&
      !(event.code === 'Space' && event.target instanceof HTMLButtonElement)
    ) {
      event.preventDefault();
      this.#held.add(event.code);
      this.room.invalidate();
      this.events.onUse();
    }
  }

  #keyUp(code: string): void {
    this.#held.delete(code);
    if (arrows[code] === this.#stepping?.direction) this.#stopSteps();
  }

  #startSteps(direction: Direction): void {
    this.#stopSteps();
    const step = () => this.events.onStep(direction);
    step();
    this.#stepping = { direction, timer: setInterval(step, 1000 / stepsPerSecond) };
    this.events.onUse();
  }

  #stopSteps(): void {
    clearInterval(this.#stepping?.timer);
    this.#stepping = undefined;
  }

  #releaseAll(): void {
    this.#held.clear();
    this.#stopSteps();
  }

  #wireButton(button: HTMLButtonElement): void {
    const direction = button.dataset['direction'] as Direction;
    button.addEventListener('pointerdown', (event) => {
      button.setPointerCapture(event.pointerId);
      this.#startSteps(direction);
    });
    for (const type of ['pointerup', 'pointercancel', 'lostpointercapture'])
      button.addEventListener(type, () => this.#stopSteps());
    // Pressed by keyboard or screen reader there is no pointer, only a click (detail 0).
    button.addEventListener('click', ({ detail }) => {
      if (detail === 0) this.events.onStep(direction);
    });
    button.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  #pointerDown(event: PointerEvent): void {
    this.canvas.setPointerCapture(event.pointerId);
    this.#pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.#travel = 0;
  }

  #pointerMove(event: PointerEvent): void {
    if (document.pointerLockElement === this.canvas) {
      this.#flight.turn(event.movementX, event.movementY);
      return this.room.invalidate();
    }
    const last = this.#pointers.get(event.pointerId);
    if (!last) return;
    const [dx, dy] = [event.clientX - last.x, event.clientY - last.y];
    this.#travel += Math.abs(dx) + Math.abs(dy);
    if (this.#pointers.size === 1) this.#flight.drag(dx, dy);
    else this.#twoFingers(event, last, dx, dy);
    this.#pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.room.invalidate();
    if (this.#travel > clickSlop) this.events.onUse();
  }

  /** Spreading flies ahead, sliding flies sideways; each finger brings half of it. */
  #twoFingers(event: PointerEvent, last: { x: number; y: number }, dx: number, dy: number): void {
    const other = [...this.#pointers].find(([id]) => id !== event.pointerId)?.[1];
    if (!other) return;
    const spread =
      Math.hypot(event.clientX - other.x, event.clientY - other.y) -
      Math.hypot(last.x - other.x, last.y - other.y);
    const scale = (1.5 * this.room.height) / this.canvas.clientHeight;
    this.#flight.move((-dx / 2) * scale, (dy / 2) * scale, spread * scale);
  }

  /** A click on nothing in particular takes the mouse for looking around, until Esc or the next click. */
  #pointerUp(event: PointerEvent): void {
    const alone = this.#pointers.size === 1;
    this.#pointers.delete(event.pointerId);
    const tapped = alone && this.#travel <= clickSlop && !document.pointerLockElement;
    if (tapped && this.events.onTap(event.clientX, event.clientY)) return;
    if (event.pointerType !== 'mouse' || event.button !== 0) return;
    if (document.pointerLockElement) document.exitPointerLock();
    else if (this.#travel <= clickSlop)
      void Promise.resolve(this.canvas.requestPointerLock()).catch(() => {});
  }

  #wheel(event: WheelEvent): void {
    event.preventDefault();
    this.#flight.move(0, 0, (-event.deltaY / 1000) * this.room.height);
    this.room.invalidate();
    this.events.onUse();
  }
}

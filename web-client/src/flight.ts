import { Euler, Vector3, type PerspectiveCamera } from 'three';

/** Radians a pixel of mouse or finger. */
const turnPerPixel = 0.0035;
const steepest = Math.PI / 2 - 0.01;

/** A camera that flies: turned by yaw and pitch, never rolled. */
export class Flight {
  readonly #angles = new Euler(0, 0, 0, 'YXZ');

  constructor(private readonly camera: PerspectiveCamera) {}

  /** Looks around by pixels of mouse movement; right and down are positive. */
  turn(dx: number, dy: number): void {
    this.#angles.y -= dx * turnPerPixel;
    this.#angles.x = Math.max(-steepest, Math.min(steepest, this.#angles.x - dy * turnPerPixel));
    this.camera.quaternion.setFromEuler(this.#angles);
  }

  /** Grabs the view and pulls it along, as a finger does. */
  drag(dx: number, dy: number): void {
    this.turn(-dx, -dy);
  }

  /** Metres to the camera's right, up along the world's y, and ahead. */
  move(right: number, up: number, ahead: number): void {
    const step = new Vector3(right, 0, -ahead).applyQuaternion(this.camera.quaternion);
    this.camera.position.add(step).y += up;
  }
}

import { Color, LinearSRGBColorSpace } from 'three';
import type { Lights } from './lights';
import type { Light, LightScale } from './protocol';

/** A row for each light: a switch with its name, how bright, and its colour. */
export class LightPanel {
  readonly #panel = document.getElementById('lights') as HTMLElement;
  readonly #list = document.getElementById('light-list') as HTMLElement;
  #rows: Row[] = [];

  constructor(private readonly lights: Lights) {}

  show(lights: readonly Light[]): void {
    this.#panel.hidden = lights.length === 0;
    document.body.toggleAttribute('data-lights', lights.length > 0);
    if (this.#rows.map(({ name }) => name).join('\n') !== lights.map(({ name }) => name).join('\n')) {
      this.#rows = lights.map(({ name }, i) => new Row(name, i, this.lights));
      this.#list.replaceChildren(...this.#rows.map(({ item }) => item));
    }
    lights.forEach(({ scale }, i) => this.#rows[i]?.show(scale));
  }
}

class Row {
  readonly item = document.createElement('li');
  readonly #toggle = document.createElement('button');
  readonly #level = document.createElement('input');
  readonly #colour = document.createElement('input');

  constructor(
    readonly name: string,
    index: number,
    lights: Lights,
  ) {
    this.#toggle.type = 'button';
    this.#toggle.textContent = name;
    this.#toggle.addEventListener('click', () => lights.toggle(index));
    Object.assign(this.#level, { type: 'range', min: '0', max: '2', step: '0.01' });
    this.#level.setAttribute('aria-label', `Brightness of ${name}`);
    this.#colour.type = 'color';
    this.#colour.setAttribute('aria-label', `Colour of ${name}`);
    for (const input of [this.#level, this.#colour])
      input.addEventListener('input', () => lights.dim(index, this.#scale()));
    this.item.append(this.#toggle, this.#level, this.#colour);
  }

  /** What somebody is setting just now is left to them. */
  show(scale: LightScale): void {
    const level = Math.max(...scale);
    this.#toggle.setAttribute('aria-pressed', String(level > 0));
    if (document.activeElement !== this.#level) this.#level.value = String(level);
    if (document.activeElement === this.#colour || level === 0) return;
    const colour = new Color().fromArray(scale.map((channel) => channel / level));
    this.#colour.value = `#${colour.copyLinearToSRGB(colour).getHexString(LinearSRGBColorSpace)}`;
  }

  #scale(): LightScale {
    const { r, g, b } = new Color(this.#colour.value).copySRGBToLinear(new Color(this.#colour.value));
    const level = this.#level.valueAsNumber / Math.max(r, g, b, 1e-3);
    return [r * level, g * level, b * level];
  }
}

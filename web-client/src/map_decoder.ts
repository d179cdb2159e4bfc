import { decode, type EncodedMap } from './map_format';

export interface MapDecoderEvents {
  onPicture(picture: ImageBitmap, map: EncodedMap): void;
  onBroken(): void;
}

/** Decodes one map at a time; of those that come meanwhile only the newest counts. */
export class MapDecoder {
  #next: EncodedMap | undefined;
  #busy = false;

  constructor(private readonly events: MapDecoderEvents) {}

  async take(map: EncodedMap): Promise<void> {
    this.#next = map;
    if (this.#busy) return;
    this.#busy = true;
    for (let next = this.#takeNext(); next; next = this.#takeNext()) {
      try {
        this.events.onPicture(await decode(next), next);
      } catch {
        this.events.onBroken();
      }
    }
    this.#busy = false;
  }

  #takeNext(): EncodedMap | undefined {
    const next = this.#next;
    this.#next = undefined;
    return next;
  }
}

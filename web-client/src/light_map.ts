import { LinearFilter, NoColorSpace, Texture } from 'three';

/** The newest map as a texture; one picture is held at a time. */
export class LightMap {
  readonly texture = new Texture<ImageBitmap | undefined>();

  constructor() {
    this.texture.channel = 1; // glTF's TEXCOORD_1
    this.texture.minFilter = this.texture.magFilter = LinearFilter;
    this.texture.generateMipmaps = false;
    // The map is sRGB, and so is the screen: values come out as sent. To decode and encode them again only for filtering
    // between texels would double what a pixel costs where the processor draws.
    this.texture.colorSpace = NoColorSpace;
  }

  get picture(): ImageBitmap | undefined {
    return this.texture.image ?? undefined;
  }

  show(picture: ImageBitmap): void {
    const old = this.picture;
    // A texture's storage cannot change its size.
    if (old && (old.width !== picture.width || old.height !== picture.height)) this.texture.dispose();
    this.texture.image = picture;
    this.texture.needsUpdate = true;
    old?.close();
  }

  /** The pixels of the newest map, row 0 first, where glTF's v is 0. */
  pixels(): ImageData | undefined {
    const picture = this.picture;
    if (!picture) return undefined;
    const canvas = new OffscreenCanvas(picture.width, picture.height);
    const context = canvas.getContext('2d', { willReadFrequently: true });
    context?.drawImage(picture, 0, 0);
    return context?.getImageData(0, 0, picture.width, picture.height);
  }
}

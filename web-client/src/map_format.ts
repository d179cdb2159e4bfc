/** A map as it came over the channel. */
export interface EncodedMap {
  readonly format: MapFormat;
  readonly bytes: Blob;
}

interface Codec {
  readonly mime: string;
  /** The bytes that every file of this format begins with. */
  readonly signature: readonly number[];
  decode(bytes: Blob): Promise<ImageBitmap>;
}

/** Everything that the page knows of a format; what a server may send is in protocol.ts. */
const codecs = {
  png: {
    mime: 'image/png',
    signature: [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a],
    decode: (bytes) => createImageBitmap(bytes, { premultiplyAlpha: 'none', colorSpaceConversion: 'none' }),
  },
} satisfies Record<string, Codec>;

export type MapFormat = keyof typeof codecs;

/** "PNG", for people; with more formats "PNG or ...". */
export const formatNames = Object.keys(codecs).join(' or ').toUpperCase();

/** A map from its chunks; undefined for what is in no format of ours. */
export function recognise(chunks: readonly ArrayBuffer[]): EncodedMap | undefined {
  for (const format of Object.keys(codecs) as MapFormat[]) {
    const { mime, signature } = codecs[format];
    const head = firstBytes(chunks, signature.length);
    if (signature.every((byte, i) => head[i] === byte))
      return { format, bytes: new Blob([...chunks], { type: mime }) };
  }
  return undefined;
}

/** Rejects what is no picture. Row 0 of the map becomes the texture's v = 0, as glTF has it. */
export function decode({ format, bytes }: EncodedMap): Promise<ImageBitmap> {
  return codecs[format].decode(bytes);
}

/** The first bytes of the chunks together: a chunk may be shorter than a signature. */
function firstBytes(chunks: readonly ArrayBuffer[], length: number): number[] {
  const head: number[] = [];
  for (const chunk of chunks) {
    head.push(...new Uint8Array(chunk, 0, Math.min(chunk.byteLength, length - head.length)));
    if (head.length >= length) break;
  }
  return head;
}

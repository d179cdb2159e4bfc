import assert from 'node:assert/strict';
import { test } from 'node:test';
import { MapDecoder } from '../src/map_decoder';
import type { EncodedMap } from '../src/map_format';

const map = (text: string): EncodedMap => ({ format: 'png', bytes: new Blob([text]) });

test('of the maps that come while one is decoded only the newest is, and a broken one stops nothing', async () => {
  const started: { succeed: () => void; fail: () => void }[] = [];
  globalThis.createImageBitmap = () =>
    new Promise<ImageBitmap>((resolve, reject) => {
      started.push({ succeed: () => resolve({} as ImageBitmap), fail: () => reject(new Error()) });
    });
  const seen: (EncodedMap | 'broken')[] = [];
  const decoder = new MapDecoder({
    onPicture: (_, shown) => seen.push(shown),
    onBroken: () => seen.push('broken'),
  });

  const [first, second, third] = [map('first'), map('second'), map('third')];
  const done = decoder.take(first);
  await decoder.take(second);
  await decoder.take(third);
  assert.equal(started.length, 1);
  started[0]!.fail();
  while (started.length < 2) await new Promise((resolve) => setImmediate(resolve));
  started[1]!.succeed();
  await done;
  assert.deepEqual(seen, ['broken', third]);
});

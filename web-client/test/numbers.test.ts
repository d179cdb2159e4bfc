import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Backoff } from '../src/backoff';
import { MapStatistics } from '../src/statistics';

test('pauses double up to 2 s, are 8 s after ten attempts, shortened by at most half, and start again', () => {
  const longest = new Backoff(() => 0);
  assert.deepEqual(
    Array.from({ length: 12 }, () => longest.next()),
    [500, 1000, ...Array<number>(8).fill(2000), 8000, 8000],
  );
  const shortest = new Backoff(() => 1);
  assert.deepEqual([shortest.next(), shortest.next()], [250, 500]);
  longest.reset();
  assert.equal(longest.next(), 500);
});

test('the rate is over the last five seconds, the age since the last map', () => {
  const statistics = new MapStatistics();
  assert.equal(statistics.describe(0), undefined);
  for (let ms = 0; ms <= 10_000; ms += 500) statistics.count(43 * 1024, 256, 256, ms);
  assert.deepEqual(statistics.describe(10_200), { rate: '1.9', age: '0.2 s', size: '256 × 256, 43 KB' });
  assert.deepEqual(statistics.describe(40_000), { rate: '0.0', age: '30 s', size: '256 × 256, 43 KB' });
  assert.equal(statistics.received, 21);
});

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { joinToken, StaySecret } from '../src/ticket';

test('the token is what follows #join=, and nothing else is one', () => {
  assert.equal(joinToken('#join=aa.b-b.c_c'), 'aa.b-b.c_c');
  for (const fragment of [
    '',
    '#',
    '#join=',
    '#join=a b',
    '#token=a',
    '#join=a&b=c',
    `#join=${'a'.repeat(2001)}`,
  ])
    assert.equal(joinToken(fragment), undefined, fragment);
});

class Store {
  readonly map = new Map<string, string>();
  getItem = (key: string): string | null => this.map.get(key) ?? null;
  setItem = (key: string, value: string): void => void this.map.set(key, value);
  removeItem = (key: string): void => void this.map.delete(key);
}

test('the secret survives a reload, and is in the storage meanwhile only', () => {
  const store = new Store();
  const first = new StaySecret(store);
  assert.equal(first.get(), undefined);
  first.set('one');
  assert.equal(store.map.size, 0);
  first.keep();
  const second = new StaySecret(store);
  assert.equal(second.get(), 'one');
  assert.equal(store.map.size, 0, 'a copy of the tab finds nothing');
  second.keep();
  second.takeBack();
  assert.deepEqual([second.get(), store.map.size], ['one', 0]);
});

test('without a storage there is a secret all the same', () => {
  const secret = new StaySecret(undefined);
  secret.set('one');
  secret.keep();
  assert.equal(secret.get(), 'one');
});

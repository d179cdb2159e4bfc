import assert from 'node:assert/strict';
import { createServer } from 'node:http';
import type { AddressInfo } from 'node:net';
import { test, type TestContext } from 'node:test';
import { Backoff } from '../src/backoff';
import { fetchScene } from '../src/scene_file';
import { Surfaces } from '../src/surfaces';

const surfaces = new Surfaces();

/** A server that gives these answers one after the other. */
async function serve(t: TestContext, answers: { status: number; body: string }[]): Promise<string> {
  const server = createServer((_request, response) => {
    const { status, body } = answers.shift() ?? { status: 500, body: '' };
    response.writeHead(status, { Connection: 'close' }).end(body);
  });
  await new Promise<void>((resolve) => server.listen(0, '127.0.0.1', resolve));
  t.after(() => server.close());
  return `http://127.0.0.1:${(server.address() as AddressInfo).port}/scene.glb`;
}

const movable = { movable: true };
const good = JSON.stringify({
  asset: { version: '2.0' },
  scenes: [{ nodes: [3, 0] }],
  nodes: [
    { name: 'outer', extras: movable, children: [1] },
    { name: 'between', children: [2] },
    { name: 'inner', extras: movable },
    { name: 'still', extras: { movable: 'yes' }, children: [4] },
    { name: 'other', extras: movable },
  ],
});

test('only the outermost movable node of a branch is movable, in the order of the file', async (t) => {
  const url = await serve(t, [{ status: 200, body: good }]);
  const file = await fetchScene({ url }, surfaces, (reason) => assert.fail(reason));
  assert.deepEqual(
    file.movable.map(({ name }) => name),
    ['outer', 'other'],
  );
});

test('a scene that cannot be had is told each time and asked for again', { timeout: 10_000 }, async (t) => {
  const url = await serve(t, [
    { status: 404, body: '' },
    { status: 200, body: 'glTF, but no more' },
    { status: 200, body: good },
  ]);
  const told: string[] = [];
  const file = await fetchScene(
    { url },
    surfaces,
    (reason, pause) => {
      assert.ok(pause > 0);
      told.push(reason);
    },
    new Backoff(() => 1),
  );
  assert.equal(file.movable.length, 2);
  assert.equal(told.length, 2);
  assert.match(told[0] ?? '', /HTTP 404 for \/scene\.glb/);
  assert.match(told[1] ?? '', /cannot be drawn \(.+\)/);
});

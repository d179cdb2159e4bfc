import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { createServer } from 'node:net';
import { join } from 'node:path';
import { test } from 'node:test';
import { writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { makeSite, populate } from './harness.js';

const main = fileURLToPath(new URL('../main.js', import.meta.url));

function run(t, args) {
  const child = spawn(process.execPath, [main, ...args], { stdio: ['ignore', 'pipe', 'pipe'] });
  t.after(() => child.kill('SIGKILL'));
  const output = { out: '', err: '' };
  child.stdout.on('data', (chunk) => (output.out += chunk));
  child.stderr.on('data', (chunk) => (output.err += chunk));
  const exited = once(child, 'close').then(([code]) => ({ code, ...output }));
  return { child, exited, output };
}

const argsOf = (site, port = 0) => [
  '--port',
  String(port),
  '--token-file',
  site.token,
  '--client',
  site.client,
  '--scene',
  site.scene,
];

test('a busy port ends with 2 and says which port and what to try', async (t) => {
  const blocker = createServer().listen(0, '127.0.0.1');
  await once(blocker, 'listening');
  t.after(() => blocker.close());
  const { port } = /** @type {import('node:net').AddressInfo} */ (blocker.address());
  const { code, err } = await run(t, argsOf(makeSite(t), port)).exited;
  assert.equal(code, 2);
  assert.match(err, new RegExp(`port ${port} on 127\\.0\\.0\\.1 is taken.*--port`));
});

test('bad arguments and files end with 2 and name the culprit', async (t) => {
  const site = makeSite(t);
  const empty = join(site.root, 'empty');
  writeFileSync(empty, ' \n');
  const twoWords = join(site.root, 'two-words');
  writeFileSync(twoWords, 'correct horse\n');
  const text = join(site.root, 'scene.gltf');
  writeFileSync(text, '{"asset": {"version": "2.0"}}');
  const cases = [
    [[], /--token-file is missing/],
    [['--nonsense'], /nonsense/],
    [[...argsOf(site), '--port', '99999'], /--port wants.*99999/],
    [[...argsOf(site), '--token-file', join(site.root, 'none')], /token-file .*none: ENOENT/],
    [[...argsOf(site), '--token-file', empty], /empty is empty/],
    [[...argsOf(site), '--token-file', twoWords], /two-words has white space within/],
    [[...argsOf(site), '--client', join(site.root, 'none')], /client .*none/],
    [[...argsOf(site), '--scene', join(site.root, 'none.glb')], /scene .*none\.glb: ENOENT/],
    [[...argsOf(site), '--scene', site.root], /scene .*EISDIR/],
    [[...argsOf(site), '--scene', text], /scene\.gltf is no binary glTF.*\.glb/],
    [[...argsOf(site), '--scene', empty], /empty is no binary glTF/],
  ];
  for (const [args, message] of cases) {
    const { code, err } = await run(t, args).exited;
    assert.equal(code, 2, args.join(' '));
    assert.match(err, message);
  }
});

test('SIGTERM ends it quickly with 0, and nobody takes the others for gone', async (t) => {
  const { child, exited, output } = run(t, argsOf(makeSite(t)));
  while (!output.out.includes('listens on')) await once(child.stdout, 'data');
  const [, port] = output.out.match(/:(\d+)\n/);
  const { server, clients } = await populate({ ws: `ws://127.0.0.1:${port}` }, 3);
  const heard = [];
  for (const peer of [server, ...clients.map(({ peer }) => peer)])
    peer.socket.on('message', (data) => heard.push(String(data)));
  const begin = Date.now();
  child.kill('SIGTERM');
  assert.equal((await exited).code, 0);
  assert.ok(Date.now() - begin < 2000);
  assert.equal((await server.closed).code, 1001);
  for (const { peer } of clients) assert.equal((await peer.closed).code, 1001);
  assert.deepEqual(heard, []);
});

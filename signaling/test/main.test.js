import assert from 'node:assert/strict';
import { once } from 'node:events';
import { createServer } from 'node:net';
import { join } from 'node:path';
import { test } from 'node:test';
import { writeFileSync } from 'node:fs';
import { makeSite, populate } from './harness.js';
import { argsOf, run } from './process.js';

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
    [[...argsOf(site), '--name', 'https://a'], /--name wants.*not 'https:\/\/a'/],
    [[...argsOf(site), '--tls-cert', text], /--tls-key is missing/],
    [[...argsOf(site), '--tls-cert', text, '--tls-key', text], /scene\.gltf is not a certificate/],
    [[...argsOf(site), '--trust-proxy', 'me'], /--trust-proxy wants.*not 'me'/],
    [[...argsOf(site), '--ice-server', 'x'], /--ice-server wants.*not 'x'/],
    [[...argsOf(site), '--ice-server', 'turn:a'], /turn:a wants --turn-secret-file/],
    [[...argsOf(site), '--turn-secret-file', join(site.root, 'none')], /turn-secret-file .*none: ENOENT/],
    [
      [...argsOf(site), '--join-secret-file', site.token],
      /join-secret-file .*token has 18 characters.*openssl rand -hex 32/,
    ],
    [[...argsOf(site), '--limit', 'maxEverything=1'], /--limit wants.*not 'maxEverything=1'/],
    [[...argsOf(site), '--limit', 'clientRate=1'], /--limit wants/],
    [[...argsOf(site), '--limit', 'maxClients=1\/2'], /--limit wants/],
    [[...argsOf(site), '--limit', 'constructor=1'], /--limit wants/],
  ];
  const runs = cases.map(async ([args, message]) => {
    const { code, err } = await run(t, args).exited;
    assert.equal(code, 2, args.join(' '));
    assert.match(err, message);
    assert.doesNotMatch(err, /a-secret-for-tests/);
  });
  await Promise.all(runs);
});

test('every option is taken, and --limit changes what it names', async (t) => {
  const site = makeSite(t);
  const secret = join(site.root, 'secret');
  writeFileSync(secret, 'd7'.repeat(32));
  const options = ['--name', 'room.example.org', '--trust-proxy', 'loopback', '--join-secret-file', secret];
  options.push('--ice-server', 'turn:a', '--ice-server', 'stun:b', '--turn-secret-file', secret);
  options.push('--limit', 'maxPipelinedRequests=3', '--limit', 'requestRatePerAddress=0.1/2');
  const program = run(t, [...argsOf(site), ...options]);
  const url = `http://127.0.0.1:${await program.port()}`;
  const status = async () => (await fetch(url)).status;
  assert.deepEqual([await status(), await status(), await status()], [200, 200, 429]);
  assert.doesNotMatch(program.output.err, /d7d7/);
});

test('SIGTERM ends it quickly with 0, and nobody takes the others for gone', async (t) => {
  const { child, exited, port } = run(t, argsOf(makeSite(t)));
  const { server, clients } = await populate({ ws: `ws://127.0.0.1:${await port()}` }, 3);
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

import assert from 'node:assert/strict';
import { createHmac } from 'node:crypto';
import { test } from 'node:test';
import { createIce } from '../ice.js';
import { Peer, start } from './harness.js';

const stun = 'stun:stun.example.org:3478';
const turn = ['turn:turn.example.org', 'turns:turn.example.org:443?transport=tcp'];
const secret = 'shared-with-coturn';

test('credentials are what coturn reckons itself, and say when they end', () => {
  const ice = createIce([turn[0], stun, turn[1]], secret, 3600, () => 1_000_000_500);
  const username = '1003600:some-id';
  const credential = createHmac('sha1', secret).update(username).digest('base64');
  assert.deepEqual(ice.serversFor('some-id'), [{ urls: [stun] }, { urls: turn, username, credential }]);
  assert.equal(ice.refreshMs, 1_800_000);
});

test('STUN alone expires never, and nothing is nothing', () => {
  const ice = createIce([stun]);
  assert.deepEqual([ice.serversFor('x'), ice.refreshMs], [[{ urls: [stun] }], undefined]);
  assert.equal(createIce([]).serversFor('x'), undefined);
});

test('what is no address of a server, or has no secret, is refused at the start', () => {
  const good = ['stun:192.0.2.1', 'turn:[2001:db8::1]:3478?transport=udp', ...turn];
  assert.doesNotThrow(() => createIce(good, secret));
  const bad = [
    'stun.example.org',
    'stun://stun.example.org',
    'stun:',
    'stun:a:0',
    'stun:a:65536',
    'stun:a?transport=udp',
  ];
  bad.push('turn:a?transport=tls', 'http://a', 'turn:user:pass@a', 'stuns:a', '');
  for (const url of bad) assert.throws(() => createIce([url], secret), /--ice-server wants/, url);
  assert.throws(() => createIce(turn), /turn:turn\.example\.org wants --turn-secret-file/);
  assert.throws(() => createIce([stun], secret), /--turn-secret-file is for turn/);
});

test('both sides are told, each in its own name, and the render server again before they expire', async (t) => {
  const limits = { turnLifetimeSeconds: 0.4 };
  const signaling = await start(t, { iceServers: [stun, ...turn], turnSecret: secret, limits });
  const server = Peer.server(signaling.ws);
  const first = await server.next();
  const client = Peer.client(signaling.ws);
  const welcome = await client.next();
  for (const { id, iceServers } of [first, welcome]) {
    assert.deepEqual(
      iceServers.map(({ urls }) => urls),
      [[stun], turn],
    );
    assert.equal(iceServers[1].username.split(':')[1], id);
  }
  const again = await server.next(1000);
  assert.deepEqual([again.type, again.id], ['welcome', first.id]);
  assert.ok(again.iceServers);
  // Clients need them once, while they join.
  await assert.rejects(client.next(500));
});

test('without servers nothing is said of them', async (t) => {
  const signaling = await start(t);
  assert.ok(!('iceServers' in (await Peer.server(signaling.ws).next())));
  assert.ok(!('iceServers' in (await Peer.client(signaling.ws).next())));
});

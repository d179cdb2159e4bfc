import assert from 'node:assert/strict';
import { createHmac } from 'node:crypto';
import { test } from 'node:test';
import { createIceServers, kindOfIceServer } from '../ice.js';
import { Peer, start } from './harness.js';

test('addresses of STUN and TURN servers are told from others', () => {
  for (const url of [
    'stun:stun.example.org',
    'stun:203.0.113.1:3478',
    'stuns:a.b:5349',
    'stun:[2001:db8::1]:3478',
  ])
    assert.equal(kindOfIceServer(url), 'stun', url);
  for (const url of ['turn:a.b', 'turn:a.b:3478?transport=tcp', 'turns:a.b:443?transport=tcp'])
    assert.equal(kindOfIceServer(url), 'turn', url);
  for (const url of [
    '',
    'http://a.b',
    'stun:',
    'turn:a.b?transport=sctp',
    'stun://a.b',
    'turn:a b',
    'stun:a.b?x',
  ])
    assert.equal(Boolean(kindOfIceServer(url)), false, url);
});

test('TURN credentials are those of coturn: the end of their time, and its HMAC', () => {
  const make = createIceServers({
    urls: ['stun:a.b', 'turn:a.b'],
    turnSecret: 'shared',
    lifetimeMs: 3_600_000,
  });
  const username = '1700003600:peer';
  const credential = createHmac('sha1', 'shared').update(username).digest('base64');
  assert.deepEqual(make('peer', 1_700_000_000_000), [
    { urls: ['stun:a.b'] },
    { urls: ['turn:a.b'], username, credential },
  ]);
  assert.deepEqual(createIceServers({ urls: [], lifetimeMs: 1 })('peer'), []);
});

test('both sides are handed them, and the render server again before they expire', async (t) => {
  const iceUrls = ['stun:203.0.113.1', 'turn:203.0.113.1'];
  const signaling = await start(t, { iceUrls, turnSecret: 'shared', limits: { turnLifetimeMs: 600 } });
  const server = Peer.server(signaling.ws);
  const greeting = await server.next();
  assert.equal(greeting.iceServers[1].username.endsWith(`:${greeting.id}`), true);
  const again = await server.next();
  assert.deepEqual([again.type, again.id, again.iceServers.length], ['welcome', greeting.id, 2]);
  const client = Peer.client(signaling.ws);
  const { id, iceServers } = await client.next();
  assert.deepEqual(iceServers[0], { urls: ['stun:203.0.113.1'] });
  assert.equal(iceServers[1].username.endsWith(`:${id}`), true);
});

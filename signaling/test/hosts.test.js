import assert from 'node:assert/strict';
import { get } from 'node:http';
import { hostname } from 'node:os';
import { test } from 'node:test';
import { createHostCheck } from '../hosts.js';
import { Peer, metric, start } from './harness.js';

/** The status of a request that names this host. */
const ask = (signaling, host, path = '/') =>
  new Promise((settle, fail) =>
    get({ port: signaling.port, host: '127.0.0.1', path, headers: { Host: host } }, (response) => {
      response.resume();
      settle(response.statusCode);
    }).on('error', fail),
  );

test('addresses, localhost, our own and given names are ours, nothing else', () => {
  const isOurs = createHostCheck(['Room.example.org']);
  const port = ':8080';
  for (const host of [
    '127.0.0.1',
    '10.1.2.3',
    '[::1]',
    'localhost',
    hostname(),
    'room.example.org',
    'room.example.org.',
  ])
    for (const whole of [host, host + port]) assert.equal(isOurs(whole), true, whole);
  for (const host of [
    'evil.example',
    'room.example.org.evil.example',
    'xroom.example.org',
    '',
    '127.0.0.1.nip.io',
  ])
    assert.equal(isOurs(host), false, host);
  assert.equal(isOurs(undefined), true);
});

test('a foreign page that has its name lead here gets nothing', async (t) => {
  const signaling = await start(t, { names: ['room.example.org'] });
  const foreign = `evil.example:${signaling.port}`;
  for (const path of ['/', '/scene.glb', '/healthz', '/metrics'])
    assert.equal(await ask(signaling, foreign, path), 421, path);
  // Of one origin with us, as its visitor's browser sees it.
  const page = Peer.client(signaling.ws, { headers: { Host: foreign }, origin: `http://${foreign}` });
  assert.equal((await page.refused).status, 421);
  assert.equal(await metric(signaling, 'refused_connections_total{reason="host"}'), 5);
  assert.equal(await ask(signaling, 'room.example.org'), 200);
  const server = Peer.server(signaling.ws, { headers: { Host: 'signaling.internal' } });
  assert.equal((await server.next()).type, 'welcome', 'the render server has shown its token');
});

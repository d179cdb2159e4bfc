import assert from 'node:assert/strict';
import { once } from 'node:events';
import { connect } from 'node:net';
import { test } from 'node:test';
import { Peer, metric, populate, start } from './harness.js';

test('a wrong or missing token is refused with 401', async (t) => {
  const signaling = await start(t);
  for (const authorization of ['Bearer wrong', 'Bearer ', 'a-secret-for-tests', '']) {
    const { status, body } = await Peer.server(signaling.ws, { headers: { Authorization: authorization } })
      .refused;
    assert.equal(status, 401, `with '${authorization}'`);
    assert.match(body.error, /token/);
  }
  const { status } = await new Peer(`${signaling.ws}/server`).refused;
  assert.equal(status, 401);
  assert.equal(await metric(signaling, 'refused_connections_total{reason="token"}'), 5);
});

test('a second render server is refused with 409, and the first one stays', async (t) => {
  const signaling = await start(t);
  const { server, serverId, clients } = await populate(signaling, 1);
  const { status, body } = await Peer.server(signaling.ws).refused;
  assert.equal(status, 409);
  assert.match(body.error, /already/);
  clients[0].peer.send({ id: serverId, type: 'offer', description: 'v=0' });
  assert.equal((await server.next()).type, 'offer');
});

test('clients wait for a server, are told when it comes, goes and comes again', async (t) => {
  const signaling = await start(t);
  const client = Peer.client(signaling.ws);
  const { id, ...greeting } = await client.next();
  assert.deepEqual(greeting, { type: 'welcome' });
  assert.deepEqual(await client.next(), { type: 'waiting' });

  const sha256 = 'AB'.repeat(32);
  const first = Peer.server(signaling.ws, { headers: { 'Lichtveld-Scene': sha256 } });
  const server = (await first.next()).id;
  const scene = { url: '/scene.glb', sha256: sha256.toLowerCase() };
  assert.deepEqual(await client.next(), { type: 'welcome', id, server, scene });

  first.socket.terminate();
  assert.deepEqual(await client.next(), { type: 'waiting' });

  const second = Peer.server(signaling.ws, { headers: { 'Lichtveld-Scene': 'no hash' } });
  const again = { type: 'welcome', id, server: (await second.next()).id, scene: { url: '/scene.glb' } };
  assert.deepEqual(await client.next(), again);
});

test('pages of other hosts may not join, unless they are allowed', async (t) => {
  const signaling = await start(t, { allowedOrigins: ['https://friend.example'] });
  for (const origin of ['https://evil.example', 'null', `http://127.0.0.1:${signaling.port + 1}`])
    assert.equal((await Peer.client(signaling.ws, { origin }).refused).status, 403, origin);
  for (const origin of ['https://friend.example', signaling.http])
    assert.equal((await Peer.client(signaling.ws, { origin }).next()).type, 'welcome', origin);
});

test('a full room and a full address are told to the browser, and a place is free again after a leave', async (t) => {
  const signaling = await start(t, { limits: { maxClients: 2, maxClientsPerAddress: 8 } });
  const { clients } = await populate(signaling, 2);
  assert.deepEqual(await Peer.client(signaling.ws).closed, { code: 1013, reason: 'the room is full' });
  clients[0].peer.socket.close();
  await clients[0].peer.closed;
  assert.equal((await Peer.client(signaling.ws).next()).type, 'welcome');

  const narrow = await start(t, { limits: { maxClientsPerAddress: 1 } });
  await populate(narrow, 1);
  const { code, reason } = await Peer.client(narrow.ws).closed;
  assert.equal(code, 1013);
  assert.match(reason, /address/);
  assert.equal(await metric(narrow, 'refused_connections_total{reason="address_full"}'), 1);
});

test('other paths do not upgrade', async (t) => {
  const signaling = await start(t);
  assert.equal((await new Peer(`${signaling.ws}/elsewhere`).refused).status, 404);
});

test('refused upgrades that never end their side do not keep their places', { timeout: 5000 }, async (t) => {
  const sockets = [];
  t.after(() => sockets.forEach((socket) => socket.destroy())); // first, or the server would wait for them
  const signaling = await start(t, { limits: { maxTcpConnections: 2 } });
  for (const path of ['/elsewhere', '/server']) {
    const socket = connect({ host: '127.0.0.1', port: signaling.port, allowHalfOpen: true });
    sockets.push(socket);
    socket.on('error', () => {});
    socket.write(
      `GET ${path} HTTP/1.1\r\nHost: a\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n` +
        'Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n',
    );
    let answer = '';
    socket.on('data', (data) => (answer += data));
    await once(socket, 'end');
    assert.match(answer, /^HTTP\/1\.1 40[14] .*\{"error":".+"\}$/s);
  }
  await new Promise((resolve) => setTimeout(resolve, 200));
  assert.equal((await Peer.client(signaling.ws).next(1000)).type, 'welcome');
});

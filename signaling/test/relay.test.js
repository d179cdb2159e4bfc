import assert from 'node:assert/strict';
import { test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { defaultLimits } from '../limits.js';
import { Peer, metric, populate, start } from './harness.js';

test("messages reach the named peer with the sender's id and only the known fields", async (t) => {
  const signaling = await start(t);
  const { server, serverId, clients } = await populate(signaling, 2);
  const [a, b] = clients;

  a.peer.send({ id: serverId, type: 'offer', description: 'v=0', sneaked: 'in' });
  assert.deepEqual(await server.next(), { id: a.id, type: 'offer', description: 'v=0' });
  server.send({ id: a.id, type: 'answer', description: 'v=1' });
  assert.deepEqual(await a.peer.next(), { id: serverId, type: 'answer', description: 'v=1' });
  b.peer.send({ id: serverId, type: 'candidate', candidate: 'candidate:1', mid: '0' });
  assert.deepEqual(await server.next(), { id: b.id, type: 'candidate', candidate: 'candidate:1', mid: '0' });
  server.send({ id: b.id, type: 'role', cube: 2, players: 2, watchers: 0 });
  assert.deepEqual(await b.peer.next(), { id: serverId, type: 'role', cube: 2, players: 2, watchers: 0 });
  assert.equal(await metric(signaling, 'relayed_messages_total{type="role"}'), 1);
});

test('the secret of a session goes from the server to its client and back, and is a plain word', async (t) => {
  const signaling = await start(t);
  const { server, serverId, clients } = await populate(signaling, 1);
  const [{ peer, id }] = clients;
  const session = 'aZ09-_'.repeat(11).slice(0, 64);
  server.send({ id, type: 'role', cube: 1, players: 1, watchers: 0, session });
  assert.equal((await peer.next()).session, session);
  peer.send({ id: serverId, type: 'offer', description: 'v=0', session });
  assert.deepEqual(await server.next(), { id, type: 'offer', description: 'v=0', session });
  peer.send({ id: serverId, type: 'rejoin', session, sneaked: 'in' });
  assert.deepEqual(await server.next(), { id, type: 'rejoin', session });

  const bad = ['', 'x'.repeat(65), 'a b', 'ä', 'a\n', 7, null, ['x'], {}];
  for (const wrong of bad) {
    peer.send({ id: serverId, type: 'rejoin', session: wrong });
    peer.send({ id: serverId, type: 'candidate', candidate: 'c', mid: '0' });
    assert.equal((await server.next()).type, 'candidate');
  }
  peer.send({ id: serverId, type: 'rejoin' });
  peer.send({ id: serverId, type: 'offer', description: 'v=0', session: 'a b' });
  server.send({ id, type: 'rejoin', session });
  server.send({ id, type: 'role', cube: 1, players: 1, watchers: 0, session: 'a b' });
  server.send({ id, type: 'answer', description: 'v=0' });
  assert.equal((await peer.next()).type, 'answer');
  assert.equal(await metric(signaling, 'refused_messages_total{reason="malformed"}'), bad.length + 3);
  assert.equal(await metric(signaling, 'refused_messages_total{reason="forbidden_type"}'), 1);
});

test('offers of an address are bounded, beside the one that each welcome asks for', async (t) => {
  const offerRatePerAddress = { perSecond: 0, burst: 2 };
  const signaling = await start(t, { limits: { offerRatePerAddress } });
  const { server, serverId, clients } = await populate(signaling, 2);
  const offer = { id: serverId, type: 'offer', description: 'v=0' };
  for (let i = 0; i < 10; ++i) clients[0].peer.send(offer);
  clients[1].peer.send({ ...offer, description: 'owed' });
  for (let i = 0; i < 3; ++i) assert.equal((await server.next()).id, clients[0].id);
  assert.equal((await server.next()).description, 'owed');
  assert.equal(await metric(signaling, 'refused_messages_total{reason="offer_rate"}'), 7);

  // A render server that comes back is offered a channel by everybody.
  server.socket.close();
  for (const { peer } of clients) assert.equal((await peer.next()).type, 'waiting');
  const back = Peer.server(signaling.ws);
  const { id } = await back.next();
  for (const { peer } of clients) {
    assert.equal((await peer.next()).server, id);
    peer.send({ ...offer, id });
    assert.equal((await back.next()).type, 'offer');
  }
});

test("the render server's work is shown in /metrics while it is there, and nobody else's", async (t) => {
  const signaling = await start(t);
  const { server, serverId, clients } = await populate(signaling, 1);
  const [{ peer: client }] = clients;
  /** In the order of one connection: once this has come, everything before it has been taken. */
  const sync = async () => {
    server.send({ id: clients[0].id, type: 'answer', description: 'v=0' });
    await client.next();
  };
  const stages = [{ name: 'update', runs: 3, seconds: 0.25, sneaked: 'in' }];
  const counts = [{ name: 'moves', value: 7 }];
  server.send({ type: 'work', stages, passes: [{ name: 'gather', runs: 6, seconds: 0.125 }], counts });
  await sync();
  const text = await (await fetch(`${signaling.http}/metrics`)).text();
  assert.match(text, /^lichtveld_server_stage_seconds_total\{stage="update"\} 0.25$/m);
  assert.match(text, /^lichtveld_server_stage_runs_total\{stage="update"\} 3$/m);
  assert.match(text, /^lichtveld_server_pass_seconds_total\{pass="gather"\} 0.125$/m);
  assert.match(text, /^lichtveld_server_counted_total\{what="moves"\} 7$/m);

  const many = Array.from({ length: defaultLimits.maxWorkEntries + 1 }, () => stages[0]);
  const malformed = [
    undefined,
    'text',
    many,
    [null],
    [{ name: 'Update"}', runs: 1, seconds: 1 }],
    [{ name: ['update'], runs: 1, seconds: 1 }],
    [{ name: 'update', runs: -1, seconds: 1 }],
    [{ name: 'update', runs: 0.5, seconds: 1 }],
    [{ name: 'update', runs: 1, seconds: -1 }],
    [{ name: 'update', runs: 1, seconds: null }],
  ];
  for (const bad of malformed) server.send({ type: 'work', stages: bad, passes: [], counts: [] });
  server.send({ type: 'work', stages: [], passes: [], counts: [{ name: 'moves', value: -1 }] });
  client.send({ type: 'work', stages: [], passes: [], counts: [] });
  client.send({ id: serverId, type: 'offer', description: 'v=0' });
  await server.next();
  await sync();
  assert.equal(await metric(signaling, 'refused_messages_total{reason="malformed"}'), malformed.length + 1);
  assert.equal(await metric(signaling, 'refused_messages_total{reason="forbidden_type"}'), 1);
  assert.match(
    await (await fetch(`${signaling.http}/metrics`)).text(),
    /stage_runs_total\{stage="update"\} 3/,
  );

  server.socket.close();
  await client.next();
  assert.doesNotMatch(await (await fetch(`${signaling.http}/metrics`)).text(), /stage="update"/);
});

test('the server hears of a client that leaves, however it leaves', async (t) => {
  const signaling = await start(t);
  const { server, clients } = await populate(signaling, 2);
  clients[0].peer.socket.close();
  assert.deepEqual(await server.next(), { id: clients[0].id, type: 'gone' });
  clients[1].peer.socket.terminate();
  assert.deepEqual(await server.next(), { id: clients[1].id, type: 'gone' });
});

test('clients cannot talk to clients, claim roles or leave for others', async (t) => {
  const signaling = await start(t);
  const { server, serverId, clients } = await populate(signaling, 2);
  const [a, b] = clients;
  a.peer.send({ id: b.id, type: 'offer', description: 'v=0' });
  a.peer.send({ id: serverId, type: 'role', cube: 1, players: 1, watchers: 0 });
  a.peer.send({ id: b.id, type: 'gone' });
  a.peer.send({ id: serverId, type: 'offer', description: 'the only one that passes' });
  assert.equal((await server.next()).description, 'the only one that passes');
  await assert.rejects(b.peer.next(100));
  for (const reason of ['forbidden_route', 'forbidden_type', 'unknown_type'])
    assert.equal(await metric(signaling, `refused_messages_total{reason="${reason}"}`), 1, reason);
});

test('garbage is counted, then closes its sender with 1008; nobody else notices', async (t) => {
  const signaling = await start(t);
  const { server, serverId, clients } = await populate(signaling, 2);
  const garbage = [
    'not json',
    '',
    '[]',
    'null',
    '7',
    '{}',
    '{"type":"offer"}',
    '{"type":"__proto__","id":"x"}',
    { id: serverId, type: 'offer', description: 7 },
    { id: serverId, type: 'offer', description: '' },
    { id: serverId, type: 'offer', description: 'x'.repeat(defaultLimits.maxDescriptionLength + 1) },
    { id: serverId, type: 'candidate', candidate: 'x', mid: 0 },
    { id: [serverId], type: 'answer', description: 'x' },
    Buffer.from([0, 255]),
  ];
  assert.ok(garbage.length < defaultLimits.maxRefusals);
  for (const value of garbage) clients[0].peer.send(value);
  clients[0].peer.send({ id: serverId, type: 'offer', description: 'still here' });
  assert.equal((await server.next()).description, 'still here');
  for (let i = garbage.length; i < defaultLimits.maxRefusals; ++i) clients[0].peer.send('more');
  assert.equal((await clients[0].peer.closed).code, 1008);
  assert.equal((await server.next()).type, 'gone');

  clients[1].peer.send({ id: serverId, type: 'offer', description: 'unharmed' });
  assert.equal((await server.next()).description, 'unharmed');
});

test('an oversized message closes its sender with 1009', async (t) => {
  const signaling = await start(t);
  const { server, clients } = await populate(signaling, 1);
  clients[0].peer.send('x'.repeat(defaultLimits.maxMessageBytes + 1));
  assert.equal((await clients[0].peer.closed).code, 1009);
  assert.equal((await server.next()).type, 'gone');
  assert.equal(await metric(signaling, 'dropped_connections_total{reason="oversized"}'), 1);
});

test('a flood is cut off after the burst, and the others go on', async (t) => {
  const signaling = await start(t);
  const { server, serverId, clients } = await populate(signaling, 2);
  const candidate = { id: serverId, type: 'candidate', candidate: 'candidate:1', mid: '0' };
  for (let i = 0; i < 1000; ++i) clients[0].peer.send(candidate);
  assert.equal((await clients[0].peer.closed).code, 1008);
  const relayed = await metric(signaling, 'relayed_messages_total{type="candidate"}');
  assert.ok(relayed >= 100 && relayed < 150, `relayed ${relayed}`);

  clients[1].peer.send({ id: serverId, type: 'offer', description: 'unharmed' });
  for (let message = await server.next(); message.description !== 'unharmed'; message = await server.next());
});

test('pings count as messages do, and bytes count whatever they are', async (t) => {
  const signaling = await start(t);
  const { server, serverId, clients } = await populate(signaling, 3);
  const [pinging, wordy, other] = clients;
  for (let i = 0; i < 1000; ++i) pinging.peer.socket.ping();
  assert.equal((await pinging.peer.closed).code, 1008);
  assert.deepEqual(await server.next(), { id: pinging.id, type: 'gone' });

  const description = 'x'.repeat(defaultLimits.maxDescriptionLength);
  for (let i = 0; i < 20; ++i) wordy.peer.send({ id: serverId, type: 'offer', description });
  assert.equal((await wordy.peer.closed).code, 1006);
  assert.equal(await metric(signaling, 'dropped_connections_total{reason="bytes"}'), 1);

  other.peer.send({ id: serverId, type: 'offer', description: 'unharmed' });
  while ((await server.next()).description !== 'unharmed');
});

test('messages to somebody who has just left are no offence', async (t) => {
  const signaling = await start(t);
  const { server, clients } = await populate(signaling, 1);
  clients[0].peer.socket.terminate();
  assert.equal((await server.next()).type, 'gone');
  for (let i = 0; i < 2 * defaultLimits.maxRefusals; ++i)
    server.send({ id: clients[0].id, type: 'candidate', candidate: 'late', mid: '0' });
  const next = Peer.client(signaling.ws);
  const { id } = await next.next();
  server.send({ id, type: 'answer', description: 'v=0' });
  assert.equal((await next.next()).type, 'answer');
});

test('a peer that stops answering pings is gone, one that answers stays', async (t) => {
  const signaling = await start(t, { limits: { pingIntervalMs: 50 } });
  const silent = Peer.server(signaling.ws, { autoPong: false });
  await silent.next();
  const client = Peer.client(signaling.ws);
  assert.ok((await client.next()).server);
  assert.deepEqual(await client.next(), { type: 'waiting' });
  assert.equal((await silent.closed).code, 1006);
  const back = Peer.server(signaling.ws);
  assert.equal((await back.next()).type, 'welcome');
  await sleep(300);
  assert.equal(client.socket.readyState, client.socket.OPEN);
  assert.equal(await metric(signaling, 'dropped_connections_total{reason="silent"}'), 1);
});

test('a client that does not read is dropped before it costs memory', async (t) => {
  const signaling = await start(t, { limits: { maxBufferedBytes: 64 * 1024 } });
  const { server, clients } = await populate(signaling, 1);
  clients[0].peer.socket.pause();
  const description = 'x'.repeat(defaultLimits.maxDescriptionLength);
  // The kernel's own buffers take a few MB before ours begins to fill.
  for (let i = 0; i < 1500; ++i) server.send({ id: clients[0].id, type: 'answer', description });
  assert.deepEqual(await server.next(10_000), { id: clients[0].id, type: 'gone' });
  assert.equal(await metric(signaling, 'dropped_connections_total{reason="does_not_read"}'), 1);
});

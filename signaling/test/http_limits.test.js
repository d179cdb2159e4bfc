import assert from 'node:assert/strict';
import { once } from 'node:events';
import { connect } from 'node:net';
import { test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { Peer, metric, start } from './harness.js';

const get = (path) => `GET ${path} HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n`;

/** A connection that sends this and keeps what it gets, and how long it lived. */
function raw(signaling, text, { localAddress = '127.0.0.1' } = {}) {
  const socket = connect({ host: '127.0.0.1', port: signaling.port, localAddress });
  const got = { text: '' };
  socket.on('error', () => {});
  socket.on('data', (chunk) => (got.text += chunk.toString('latin1')));
  socket.write(text);
  const begin = performance.now();
  const closed = new Promise((resolve) => socket.on('close', () => resolve(performance.now() - begin)));
  return { socket, got, closed };
}

const dropped = (signaling, reason) => metric(signaling, `dropped_connections_total{reason="${reason}"}`);

test('a few requests at once are answered in order, many end the connection', async (t) => {
  const signaling = await start(t);
  const few = raw(
    signaling,
    get('/healthz').repeat(10) + get('/none').replace('\r\n\r\n', '\r\nConnection: close\r\n\r\n'),
  );
  await few.closed;
  assert.deepEqual(few.got.text.match(/HTTP\/1\.1 \d+/g), [
    ...Array(10).fill('HTTP/1.1 200'),
    'HTTP/1.1 404',
  ]);
  const many = raw(signaling, get('/').repeat(5000));
  assert.ok((await many.closed) < 2000);
  assert.equal(await dropped(signaling, 'pipelined'), 1);
});

test('a connection has so many requests, then the client opens another', async (t) => {
  const signaling = await start(t, { limits: { maxRequestsPerConnection: 3 } });
  const { socket, got, closed } = raw(signaling, '');
  for (let i = 1; i <= 3; ++i) {
    socket.write(get('/healthz'));
    while (got.text.split('HTTP/1.1 200').length <= i) await once(socket, 'data');
  }
  assert.match(got.text, /Connection: close/);
  socket.write(get('/healthz')); // who does not hear of it is cut off
  assert.ok((await closed) < 2000);
});

test('headers that do not come in time, are too large or none end the connection', async (t) => {
  const signaling = await start(t, { limits: { headersTimeoutMs: 500, maxHeaderBytes: 2048 } });
  const cases = [
    ['GET / HTTP/1.1\r\nX: ', 'HTTP/1.1 408 ', 'headers_timeout'],
    [`GET / HTTP/1.1\r\nX: ${'x'.repeat(4000)}\r\n\r\n`, 'HTTP/1.1 431 ', 'headers_size'],
    ['something else entirely\r\n\r\n', 'HTTP/1.1 400 ', 'no_http'],
  ];
  for (const [sent, answer, reason] of cases) {
    const { got, closed } = raw(signaling, sent);
    // They are looked at once a second.
    assert.ok((await closed) < 3000, reason);
    assert.ok(got.text.startsWith(answer), got.text);
    assert.equal(await dropped(signaling, reason), 1, reason);
  }
  const silent = raw(signaling, '');
  assert.ok((await silent.closed) < 3000);
  // Who goes in the middle has done nothing wrong.
  raw(signaling, 'GET / HTTP/1.1\r\nX: ').socket.end();
  await sleep(200);
  assert.equal(await dropped(signaling, 'no_http'), 1);
});

test('an answer that is not read ends, one that is read slowly does not', async (t) => {
  const scene = Buffer.concat([Buffer.from('glTF'), Buffer.alloc(24 * 1024 * 1024)]);
  const signaling = await start(t, { scene, limits: { answerTimeoutMs: 500 } });
  const deaf = raw(signaling, get('/scene.glb'));
  deaf.socket.pause();
  const slow = raw(signaling, get('/scene.glb').replace('\r\n\r\n', '\r\nConnection: close\r\n\r\n'));
  const nap = setInterval(() => {
    slow.socket.pause();
    setTimeout(() => slow.socket.resume(), 90);
  }, 100);
  await slow.closed;
  clearInterval(nap);
  assert.ok(slow.got.text.length > scene.length);
  await sleep(1500);
  assert.equal(await dropped(signaling, 'unread'), 1);
  deaf.socket.destroy();
});

test('an address that asks too often is told to wait, and others are not', async (t) => {
  const signaling = await start(t, { limits: { requestRatePerAddress: { perSecond: 2, burst: 3 } } });
  const status = async (localAddress) => {
    const { got, closed } = raw(signaling, get('/').replace('\r\n\r\n', '\r\nConnection: close\r\n\r\n'), {
      localAddress,
    });
    await closed;
    return Number(got.text.match(/^HTTP\/1\.1 (\d+)/)?.[1]);
  };
  const many = [];
  for (let i = 0; i < 5; ++i) many.push(await status('127.0.0.2'));
  assert.deepEqual(many, [200, 200, 200, 429, 429]);
  assert.equal(await status('127.0.0.3'), 200);
  await sleep(600);
  assert.equal(await status('127.0.0.2'), 200);
});

test('coming again after a refusal is not free: upgrades and connections are counted, refused ones too', async (t) => {
  const limits = { upgradeRatePerAddress: { perSecond: 2, burst: 3 }, maxClientsPerAddress: 1 };
  const signaling = await start(t, { limits });
  const villain = { localAddress: '127.0.0.2' };
  assert.equal((await Peer.client(signaling.ws, villain).next()).type, 'welcome');
  for (let i = 0; i < 2; ++i) assert.equal((await Peer.client(signaling.ws, villain).closed).code, 1013);
  assert.equal((await Peer.client(signaling.ws, villain).refused).status, 429);
  // The render server's token lets it in whatever its address has done; guessing it is not free either.
  assert.equal((await Peer.server(signaling.ws, villain).next()).type, 'welcome');
  assert.equal((await new Peer(`${signaling.ws}/server`, villain).refused).status, 429);
  assert.equal((await Peer.client(signaling.ws, { localAddress: '127.0.0.3' }).next()).type, 'welcome');

  const narrow = await start(t, {
    limits: { connectionRatePerAddress: { perSecond: 2, burst: 2 }, refusalDelayMs: 300 },
  });
  for (let i = 0; i < 2; ++i) raw(narrow, get('/'), villain);
  const lived = await raw(narrow, get('/'), villain).closed;
  assert.ok(lived > 250 && lived < 1000, `${lived} ms`);
  assert.equal(await metric(narrow, 'refused_connections_total{reason="connection_rate"}'), 1);
});

test('all places taken from several addresses: another visitor gets in at the expense of whoever has most', async (t) => {
  const signaling = await start(t, { limits: { maxTcpConnections: 20 } });
  const held = [];
  for (const [localAddress, count] of [
    ['127.0.0.2', 13],
    ['127.0.0.3', 7],
  ])
    for (let i = 0; i < Number(count); ++i)
      held.push(raw(signaling, 'GET / HTTP/1.1\r\nX: ', { localAddress: String(localAddress) }));
  await sleep(200);
  assert.equal((await fetch(signaling.http)).status, 200);
  await sleep(50);
  assert.ok(held[0].socket.destroyed);
  assert.equal(held.filter(({ socket }) => socket.destroyed).length, 1);
  assert.equal(await dropped(signaling, 'tcp_connections'), 1);
  for (const { socket } of held) socket.destroy();
});

test('what is refused is told in one line an interval, with how many there were', async (t) => {
  const lines = [];
  const signaling = await start(t, { limits: { logIntervalMs: 300 }, log: (line) => lines.push(line) });
  for (let i = 0; i < 20; ++i) await new Peer(`${signaling.ws}/elsewhere`).refused;
  await sleep(1000);
  assert.match(lines[0], /WebSockets are at \/server and \/client \(path, 127\.0\.0\.1\)/);
  const counted = lines
    .slice(1)
    .map((line) => Number(line.match(/^(\d+) more in 0\.3 s \(path, the last one 127\.0\.0\.1\)$/)?.[1]));
  assert.equal(
    counted.reduce((a, b) => a + b, 0),
    19,
    lines.join('\n'),
  );
  assert.ok(lines.length <= 5);
  await new Peer(`${signaling.ws}/elsewhere`).refused;
  assert.equal(lines.at(-1), lines[0], 'after a silence the first is told again');
});

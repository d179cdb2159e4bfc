import assert from 'node:assert/strict';
import { mkdirSync, symlinkSync, writeFileSync } from 'node:fs';
import { connect } from 'node:net';
import { join } from 'node:path';
import { test } from 'node:test';
import { Peer, makeSite, metric, populate, sceneBytes, start } from './harness.js';

/** One request as raw bytes: fetch() would tidy up the path before it leaves. */
function rawGet(port, path) {
  return new Promise((resolve, reject) => {
    const socket = connect(port, '127.0.0.1', () =>
      socket.write(`GET ${path} HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n`),
    );
    let text = '';
    socket.on('data', (chunk) => (text += chunk));
    socket.on('end', () => resolve(text));
    socket.on('error', reject);
  });
}

test('the page comes with security headers and is never cached stale', async (t) => {
  const signaling = await start(t);
  const response = await fetch(signaling.http);
  assert.equal(response.status, 200);
  assert.match(await response.text(), /<title>page/);
  assert.match(response.headers.get('content-security-policy') ?? '', /default-src 'self'/);
  assert.equal(response.headers.get('x-content-type-options'), 'nosniff');
  assert.equal(response.headers.get('cache-control'), 'no-cache');
});

test('nothing outside the client folder is served', async (t) => {
  const signaling = await start(t);
  const paths = [
    '/../token',
    '/%2e%2e/token',
    '/..%2ftoken',
    '/..%5ctoken',
    '//../token',
    '/%00',
    '/%ff',
    '/index.html/../../token',
  ];
  for (const path of paths) {
    const answer = await rawGet(signaling.port, path);
    assert.match(answer, /^HTTP\/1\.1 4\d\d /, path);
    assert.doesNotMatch(answer, /a-secret-for-tests/, path);
  }
});

test('the scene is served under its fixed name and revalidated by its hash', async (t) => {
  const signaling = await start(t);
  const response = await fetch(`${signaling.http}/scene.glb?v=1`);
  assert.deepEqual(Buffer.from(await response.arrayBuffer()), sceneBytes);
  const again = await fetch(`${signaling.http}/scene.glb`, {
    headers: { 'If-None-Match': response.headers.get('etag') ?? '' },
  });
  assert.equal(again.status, 304);
});

test('files have their types, are revalidated, and only those that are there are served', async (t) => {
  const site = makeSite(t);
  mkdirSync(join(site.client, 'assets'));
  const script = Buffer.alloc(300_000, 'let x = 1;\n');
  writeFileSync(join(site.client, 'assets', 'app-1a2b.js'), script);
  writeFileSync(join(site.client, 'ä b.svg'), '<svg/>');
  writeFileSync(join(site.client, 'none'), '');
  writeFileSync(join(site.client, '.hidden'), 'secret');
  symlinkSync(site.token, join(site.client, 'link'));
  const signaling = await start(t, { clientFolder: site.client });
  const load = (path, options) => fetch(`${signaling.http}${path}`, options);

  const js = await load('/assets/app-1a2b.js');
  assert.deepEqual(Buffer.from(await js.arrayBuffer()), script);
  assert.equal(js.headers.get('content-type'), 'text/javascript;charset=utf-8');
  assert.match(js.headers.get('cache-control') ?? '', /immutable/);
  const etag = js.headers.get('etag') ?? '';
  for (const tags of [etag, `W/${etag}`, `"x", ${etag}`, '*']) {
    const again = await load('/assets/app-1a2b.js', { headers: { 'If-None-Match': tags } });
    assert.deepEqual([again.status, again.headers.get('etag')], [304, etag], tags);
    assert.match(again.headers.get('content-security-policy') ?? '', /default-src/);
  }
  assert.equal((await load('/assets/app-1a2b.js', { headers: { 'If-None-Match': '"x"' } })).status, 200);
  const head = await load('/assets/app-1a2b.js', { method: 'HEAD' });
  assert.deepEqual([head.headers.get('content-length'), await head.text()], ['300000', '']);
  assert.equal((await load('/%C3%A4%20b.svg?x=1')).headers.get('content-type'), 'image/svg+xml');
  assert.equal((await load('/index.html')).status, 200);
  assert.deepEqual([(await load('/none')).status, await (await load('/none')).text()], [200, '']);
  for (const path of ['/.hidden', '/link', '/assets', '/assets/', '/constructor', '/INDEX.HTML'])
    assert.equal((await load(path)).status, 404, path);

  // What changes later is another page: it is served from the next start on.
  writeFileSync(join(site.client, 'index.html'), 'changed');
  assert.match(await (await load('/')).text(), /<title>page/);
});

test('a folder that is too large for memory is refused at the start', async (t) => {
  await assert.rejects(start(t, { limits: { maxClientBytes: 10 } }), /more than 10 bytes.*--client/);
});

test('/healthz says who is there', async (t) => {
  const signaling = await start(t);
  const health = async () => (await fetch(`${signaling.http}/healthz`)).json();
  assert.deepEqual(await health(), { status: 'ok', server: false, clients: 0 });
  await populate(signaling, 2);
  assert.deepEqual(await health(), { status: 'ok', server: true, clients: 2 });
});

test('/metrics is Prometheus text that counts connections, messages and bytes', async (t) => {
  const signaling = await start(t);
  const { serverId, server, clients } = await populate(signaling, 1);
  const text = JSON.stringify({ id: serverId, type: 'offer', description: 'v=0' });
  clients[0].peer.send(text);
  await server.next();
  const response = await fetch(`${signaling.http}/metrics`);
  assert.match(response.headers.get('content-type') ?? '', /^text\/plain/);
  assert.equal(await metric(signaling, 'clients'), 1);
  assert.equal(await metric(signaling, 'server_connected'), 1);
  assert.equal(await metric(signaling, 'connections_total{role="client"}'), 1);
  assert.equal(await metric(signaling, 'relayed_bytes_total'), text.length);
});

test('only GET and HEAD are answered', async (t) => {
  const signaling = await start(t);
  assert.equal((await fetch(signaling.http, { method: 'POST', body: 'x' })).status, 405);
});

test('close() says good-bye to everybody and is quick even when nobody answers', async (t) => {
  const signaling = await start(t);
  const { server, clients } = await populate(signaling, 1);
  const deaf = Peer.client(signaling.ws);
  await deaf.next();
  deaf.socket.pause();
  const begin = Date.now();
  await signaling.close();
  assert.ok(Date.now() - begin < 2000);
  assert.equal((await server.closed).code, 1001);
  assert.equal((await clients[0].peer.closed).code, 1001);
});

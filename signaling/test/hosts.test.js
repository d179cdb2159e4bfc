import assert from 'node:assert/strict';
import { get } from 'node:http';
import { hostname } from 'node:os';
import { test } from 'node:test';
import { createHosts } from '../hosts.js';
import { Peer, metric, start } from './harness.js';

/** @returns {Promise<{status: number, body: string}>} */
const ask = (signaling, path, host) =>
  new Promise((resolve, reject) => {
    get(`${signaling.http}${path}`, { agent: false, headers: { Host: host } }, (response) => {
      let body = '';
      response.on('data', (chunk) => (body += chunk));
      response.on('end', () => resolve({ status: Number(response.statusCode), body }));
    }).on('error', reject);
  });

test('addresses, localhost, this machine and the names that are given are served, others are not', () => {
  const hosts = createHosts(['room.example.org', 'Other.Example.org.']);
  const own = hostname().toLowerCase();
  const good = ['127.0.0.1', '127.0.0.1:8080', '[::1]:80', '[2001:db8::1]', 'localhost:1', 'LOCALHOST', own];
  good.push(
    `${own.split('.')[0]}.local:8080`,
    'room.example.org',
    'ROOM.example.org:443',
    'room.example.org.',
    'other.example.org',
  );
  for (const host of good) assert.equal(hosts.refusal(host), undefined, host);
  const bad = [
    undefined,
    '',
    'evil.example',
    'room.example.org.evil.example',
    'evilroom.example.org',
    'localhost.evil.example',
  ];
  bad.push(
    '127.0.0.1.evil.example',
    'room.example.org:80:80',
    'a@room.example.org',
    '[evil]',
    'room.example.org/x',
    '[room.example.org]',
  );
  for (const host of bad) assert.ok(hosts.refusal(host), host);
  assert.match(hosts.refusal('evil.example:8080') ?? '', /'evil\.example'.*--name evil\.example$/);
});

test('names that are none are refused at the start', () => {
  for (const name of ['https://room.example.org', 'room.example.org:8443', '', 'a b', '-x', '*.example.org'])
    assert.throws(() => createHosts([name]), /--name wants a host name such as/, name);
});

test('a page that lets its own name lead here gets nothing', async (t) => {
  const signaling = await start(t, { names: ['room.example.org'] });
  for (const path of ['/', '/index.html', '/scene.glb', '/none']) {
    const { status, body } = await ask(signaling, path, `evil.example:${signaling.port}`);
    assert.equal(status, 421, path);
    assert.match(JSON.parse(body).error, /--name evil\.example/);
    assert.notEqual((await ask(signaling, path, 'room.example.org')).status, 421);
  }
  // Its origin and its host are the same: only the host gives it away.
  const headers = { Host: 'evil.example', Origin: 'http://evil.example' };
  const { status, body } = await Peer.client(signaling.ws, { headers }).refused;
  assert.equal(status, 421);
  assert.match(body.error, /evil\.example/);
  assert.equal(await metric(signaling, 'refused_requests_total{reason="host"}'), 4);
  assert.equal(await metric(signaling, 'refused_connections_total{reason="host"}'), 1);

  const good = { Host: 'room.example.org', Origin: 'https://room.example.org' };
  assert.equal((await Peer.client(signaling.ws, { headers: good }).next()).type, 'welcome');
});

test('health checks, scrapers and the render server may use any name', async (t) => {
  const signaling = await start(t);
  for (const path of ['/healthz', '/metrics'])
    assert.equal((await ask(signaling, path, 'relay:8080')).status, 200);
  assert.equal((await Peer.server(signaling.ws, { headers: { Host: 'relay' } }).next()).type, 'welcome');
});

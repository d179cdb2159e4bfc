import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { once } from 'node:events';
import { copyFileSync, readFileSync, writeFileSync } from 'node:fs';
import { get } from 'node:https';
import { connect } from 'node:net';
import { join } from 'node:path';
import { test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { connect as connectTls } from 'node:tls';
import { readTls } from '../tls.js';
import { Peer, makeSite, start } from './harness.js';

/** An authority of our own, which has signed certificates for 127.0.0.1. */
function makeAuthority(t) {
  const { root } = makeSite(t);
  const at = (name) => join(root, name);
  const openssl = (...args) => execFileSync('openssl', args, { stdio: ['ignore', 'ignore', 'pipe'] });
  const newKey = ['-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:P-256', '-nodes'];
  openssl(
    'req',
    '-x509',
    ...newKey,
    '-subj',
    '/CN=Test CA',
    '-days',
    '2',
    '-keyout',
    at('ca.key'),
    '-out',
    at('ca.pem'),
  );
  writeFileSync(at('extensions'), 'subjectAltName=IP:127.0.0.1,DNS:room.example.org\n');
  writeFileSync(at('index.txt'), '');
  return {
    at,
    ca: readFileSync(at('ca.pem')),
    issue(name, serial, { from, to } = { from: '', to: '' }) {
      openssl(
        'req',
        ...newKey,
        '-subj',
        `/CN=${name}`,
        '-keyout',
        at(`${name}.key`),
        '-out',
        at(`${name}.csr`),
      );
      const request = ['-in', at(`${name}.csr`), '-out', at(`${name}.pem`), '-extfile', at('extensions')];
      if (!from)
        openssl(
          'x509',
          '-req',
          ...request,
          '-CA',
          at('ca.pem'),
          '-CAkey',
          at('ca.key'),
          '-set_serial',
          serial,
          '-days',
          '1',
        );
      else {
        // x509 cannot date back; ca wants a database.
        const config = `[ca]\ndefault_ca=c\n[c]\ndatabase=${at('index.txt')}\nnew_certs_dir=${root}\nrand_serial=yes\ndefault_md=sha256\npolicy=p\n[p]\ncommonName=supplied\n`;
        writeFileSync(at('ca.conf'), config);
        const dates = ['-startdate', from, '-enddate', to];
        openssl(
          'ca',
          '-batch',
          '-notext',
          '-config',
          at('ca.conf'),
          '-cert',
          at('ca.pem'),
          '-keyfile',
          at('ca.key'),
          ...dates,
          ...request,
        );
      }
      return { cert: at(`${name}.pem`), key: at(`${name}.key`) };
    },
  };
}

const over = (signaling, ca) => ({
  ...signaling,
  http: signaling.http.replace('http:', 'https:'),
  ws: signaling.ws.replace('ws:', 'wss:'),
  ca,
});

/** @returns {Promise<{status?: number, serial: string, text: string}>} */
const load = (signaling, path = '/') =>
  new Promise((resolve, reject) => {
    const request = get(`${signaling.http}${path}`, { ca: signaling.ca, agent: false }, (response) => {
      const { serialNumber } = /** @type {import('node:tls').TLSSocket} */ (
        response.socket
      ).getPeerCertificate();
      let text = '';
      response.on('data', (chunk) => (text += chunk));
      response.on('end', () => resolve({ status: response.statusCode, serial: serialNumber, text }));
    });
    request.on('error', reject);
  });

test('pages and WebSockets by TLS, and a certificate is renewed without ending a session', async (t) => {
  const authority = makeAuthority(t);
  const first = authority.issue('first', '17');
  const tls = { cert: authority.at('live.pem'), key: authority.at('live.key') };
  const use = ({ cert, key }) => {
    copyFileSync(cert, tls.cert);
    copyFileSync(key, tls.key);
  };
  use(first);
  const lines = [];
  const limits = { certificatePollMs: 50 };
  const signaling = over(await start(t, { tls, limits, log: (line) => lines.push(line) }), authority.ca);
  const server = Peer.server(signaling.ws, { ca: signaling.ca });
  const serverId = (await server.next()).id;
  const client = Peer.client(signaling.ws, { ca: signaling.ca, origin: signaling.http });
  const { id } = await client.next();
  assert.equal((await load(signaling)).serial, '11');

  // Half of a renewal, then garbage, then the whole: what is no good is told once, and the old one goes on.
  const second = authority.issue('second', '34');
  copyFileSync(second.cert, tls.cert);
  await sleep(250);
  assert.equal((await load(signaling)).serial, '11');
  writeFileSync(tls.cert, 'garbage');
  await sleep(250);
  assert.equal((await load(signaling)).serial, '11');
  use(second);
  await sleep(250);
  assert.equal((await load(signaling)).serial, '22');
  const told = lines.filter((line) => /certificate/.test(line));
  assert.equal(told.length, 3, told.join('\n'));
  assert.match(told[0], /goes on with the old certificate: .*does not belong to/);
  assert.match(told[1], /goes on with the old certificate: .*live\.pem is not a certificate/);
  assert.match(told[2], /reads the renewed certificate/);

  client.send({ id: serverId, type: 'offer', description: 'v=0' });
  assert.deepEqual(await server.next(), { id, type: 'offer', description: 'v=0' });
});

test('a certificate that ends while it is in use is named, once', async (t) => {
  const date = (/** @type {number} */ ms) => new Date(ms).toISOString().replace(/[-:T]|\..*/g, '') + 'Z';
  const from = date(Date.now() - 60_000);
  const tls = makeAuthority(t).issue('brief', '5', { from, to: date(Date.now() + 2000) });
  const lines = [];
  await start(t, { tls, limits: { certificatePollMs: 100 }, log: (line) => lines.push(line) });
  await sleep(3500);
  assert.equal(lines.length, 1);
  assert.match(lines[0], /goes on with the old certificate: .*brief\.pem expired on .*renew it/);
});

test('a certificate that is no good is named at the start', (t) => {
  const authority = makeAuthority(t);
  const good = authority.issue('good', '1');
  const other = authority.issue('other', '2');
  const stale = authority.issue('stale', '3', { from: '20240101000000Z', to: '20240201000000Z' });
  const early = authority.issue('early', '4', { from: '20900101000000Z', to: '20910101000000Z' });
  const garbage = authority.at('garbage');
  writeFileSync(garbage, 'garbage');
  const cases = [
    [{ cert: authority.at('none'), key: good.key }, /cannot read the tls-cert .*none: ENOENT.*--tls-cert/],
    [{ cert: good.cert, key: authority.at('none') }, /cannot read the tls-key .*none: ENOENT.*--tls-key/],
    [{ cert: garbage, key: good.key }, /garbage is not a certificate in PEM.*--tls-cert/],
    [{ cert: good.cert, key: garbage }, /garbage is not a private key.*--tls-key/],
    [{ cert: good.cert, key: other.key }, /other\.key does not belong to the certificate .*good\.pem/],
    [stale, /stale\.pem expired on Feb +1 .*2024.*renew it/],
    [early, /early\.pem is not valid before Jan +1 .*2090.*clock/],
  ];
  for (const [files, message] of cases) assert.throws(() => readTls(files), message);
  assert.ok(readTls(good).cert.length > 0);
});

test('limits hold below TLS too: handshakes that do not come, pipelines, unread answers', async (t) => {
  const authority = makeAuthority(t);
  const tls = authority.issue('good', '1');
  const limits = {
    tlsHandshakeTimeoutMs: 300,
    answerTimeoutMs: 600,
    maxConnectionsPerAddress: 4,
    connectionsPerAbuse: 0,
  };
  const scene = Buffer.concat([Buffer.from('glTF'), Buffer.alloc(32 * 1024 * 1024)]);
  const signaling = over(await start(t, { tls, limits, scene }), authority.ca);
  const end = async (socket) => {
    socket.on('error', () => {});
    const begin = performance.now();
    await once(socket, 'close');
    return performance.now() - begin;
  };
  const silent = connect(signaling.port, '127.0.0.1');
  silent.resume();
  assert.ok((await end(silent)) < 2000);

  const greedy = connectTls({ port: signaling.port, host: '127.0.0.1', ca: authority.ca });
  greedy.resume();
  greedy.write('GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n'.repeat(1000));
  assert.ok((await end(greedy)) < 2000);

  const deaf = connectTls({ port: signaling.port, host: '127.0.0.1', ca: authority.ca });
  deaf.write('GET /scene.glb HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n');
  deaf.on('error', () => {});
  await sleep(2000);
  const { text } = await load(signaling, '/metrics');
  for (const reason of ['pipelined', 'unread'])
    assert.match(text, new RegExp(`dropped_connections_total\\{reason="${reason}"\\} 1`));
  deaf.destroy();

  // The oldest makes room, whether its handshake is done or not.
  const held = Array.from({ length: 6 }, () => connect(signaling.port, '127.0.0.1').on('error', () => {}));
  assert.equal((await load(signaling)).status, 200);
  for (const socket of held) socket.destroy();
  await sleep(100);
  assert.match((await load(signaling, '/metrics')).text, /tcp_connections 1$/m);
});

test('close() waits for no handshake', async (t) => {
  const signaling = await start(t, { tls: makeAuthority(t).issue('good', '1') });
  const silent = connect(signaling.port, '127.0.0.1').on('error', () => {});
  await once(silent, 'connect');
  await sleep(50);
  const begin = performance.now();
  await signaling.close();
  assert.ok(performance.now() - begin < 2000);
});

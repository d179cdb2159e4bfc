import assert from 'node:assert/strict';
import { copyFileSync, readFileSync, writeFileSync } from 'node:fs';
import { connect as connectTcp } from 'node:net';
import { join } from 'node:path';
import { test } from 'node:test';
import { connect } from 'node:tls';
import { readCertificate } from '../tls.js';
import { makeAuthority } from './certificates.js';
import { Peer, makeSite, start } from './harness.js';

const pause = (ms) => new Promise((proceed) => setTimeout(proceed, ms));

/** Serial number of the certificate that the server shows. */
const shownSerial = (port, ca) =>
  new Promise((settle, fail) => {
    const socket = connect({ port, host: '127.0.0.1', servername: 'localhost', ca: readFileSync(ca) }, () => {
      settle(socket.getPeerCertificate().serialNumber);
      socket.destroy();
    });
    socket.on('error', fail);
  });

test('https and wss by a certificate of our own authority', async (t) => {
  const { root } = makeSite(t);
  const authority = makeAuthority(root);
  const signaling = await start(t, { tls: authority.issue('good') });
  const ca = readFileSync(authority.ca);
  const url = `wss://127.0.0.1:${signaling.port}`;
  const server = Peer.server(url, { ca });
  await server.next();
  const client = Peer.client(url, { ca, origin: `https://127.0.0.1:${signaling.port}` });
  assert.equal((await client.next()).type, 'welcome');
  const stranger = new Peer(`${url}/client`);
  assert.equal((await stranger.closed).code, 1006, 'an authority that is not known');
});

test(
  'a renewed certificate is taken, sessions go on, and a broken one is left alone',
  { timeout: 30_000 },
  async (t) => {
    const { root } = makeSite(t);
    const authority = makeAuthority(root);
    const [first, second] = [authority.issue('first'), authority.issue('second')];
    const used = { cert: join(root, 'used.pem'), key: join(root, 'used.key') };
    const use = ({ cert, key }) => {
      copyFileSync(cert, used.cert);
      copyFileSync(key, used.key);
    };
    use(first);
    const lines = [];
    const says = async (pattern) => {
      for (let i = 0; !lines.some((line) => pattern.test(line)); ++i) {
        assert.ok(i < 200, `it never said ${pattern}: ${lines.join('\n')}`);
        await pause(100);
      }
    };
    const signaling = await start(t, {
      tls: used,
      limits: { certificateLookMs: 200 },
      log: (line) => lines.push(line),
    });
    const ca = readFileSync(authority.ca);
    const client = Peer.client(`wss://127.0.0.1:${signaling.port}`, { ca });
    await client.next();
    const before = await shownSerial(signaling.port, authority.ca);
    use(second);
    await says(/was renewed/);
    await pause(500); // the second file's change is seen, too
    const after = await shownSerial(signaling.port, authority.ca);
    assert.notEqual(after, before);
    writeFileSync(used.cert, 'half of it');
    await says(/the old certificate stays: .*used\.pem holds no certificate/);
    assert.equal(await shownSerial(signaling.port, authority.ca), after);
    assert.equal(client.socket.readyState, client.socket.OPEN);
  },
);

test('what is wrong with a certificate is said', (t) => {
  const { root } = makeSite(t);
  const authority = makeAuthority(root);
  const good = authority.issue('good');
  const expired = authority.issue('expired', { days: '-1' });
  const other = authority.issue('other');
  assert.throws(() => readCertificate(expired), /expired\.pem expired on \w+ +\d+ .*renew/);
  assert.throws(
    () => readCertificate({ ...good, key: other.key }),
    /other\.key is no key of the certificate/,
  );
  assert.throws(() => readCertificate({ ...good, cert: good.key }), /holds no certificate/);
  assert.throws(
    () => readCertificate({ ...good, cert: join(root, 'none') }),
    /cannot read the tls-cert .*none: ENOENT/,
  );
});

test('who connects and never speaks TLS is cut off', { timeout: 10_000 }, async (t) => {
  const { root } = makeSite(t);
  const tls = makeAuthority(root).issue('good');
  const signaling = await start(t, { tls, limits: { headersTimeoutMs: 500 } });
  const mute = connectTcp(signaling.port, '127.0.0.1');
  mute.on('error', () => {});
  await new Promise((closed) => mute.once('close', closed));
});

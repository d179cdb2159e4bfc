import assert from 'node:assert/strict';
import { test } from 'node:test';
import { createAddresses } from '../addresses.js';
import { Peer, metric, start } from './harness.js';

const from = (...addresses) => ({ headers: { 'X-Forwarded-For': addresses.join(', ') } });
const limits = { maxClientsPerAddress: 1 };

test('behind a proxy that is trusted the real address counts, and what a client says of it does not', async (t) => {
  const signaling = await start(t, { trustedProxies: ['loopback'], limits });
  assert.equal((await Peer.client(signaling.ws, from('192.0.2.1')).next()).type, 'welcome');
  assert.equal((await Peer.client(signaling.ws, from('192.0.2.2')).next()).type, 'welcome');
  // The proxy adds the address that it sees behind what the client has sent itself.
  assert.equal((await Peer.client(signaling.ws, from('198.51.100.9', '192.0.2.1')).closed).code, 1013);
  assert.equal((await Peer.client(signaling.ws, from('2001:db8::1')).next()).type, 'welcome');
  assert.equal((await Peer.client(signaling.ws, from('2001:db8::2')).closed).code, 1013, 'the same /64');
});

test('nobody else is believed', async (t) => {
  for (const trustedProxies of [[], ['10.0.0.0/8']]) {
    const signaling = await start(t, { trustedProxies, limits });
    assert.equal((await Peer.client(signaling.ws, from('192.0.2.1')).next()).type, 'welcome');
    assert.equal((await Peer.client(signaling.ws, from('192.0.2.2')).closed).code, 1013);
  }
});

test("requests count for the real address, and connections for the proxy's are not bounded by address", async (t) => {
  const signaling = await start(t, {
    trustedProxies: ['127.0.0.0/8'],
    limits: {
      requestRatePerAddress: { perSecond: 0, burst: 2 },
      connectionRatePerAddress: { perSecond: 0, burst: 1 },
      maxConnectionsPerAddress: 1,
    },
  });
  const status = async (address) =>
    (await fetch(signaling.http, { headers: { Connection: 'close', 'X-Forwarded-For': address } })).status;
  assert.deepEqual(
    [await status('192.0.2.1'), await status('192.0.2.1'), await status('192.0.2.1')],
    [200, 200, 429],
  );
  assert.equal(await status('192.0.2.2'), 200);
  // A proxy that does not say whose request it is: its own share.
  assert.deepEqual(
    [await status('unknown'), await status('unknown'), await status('unknown')],
    [200, 200, 429],
  );
  const asked = await fetch(`${signaling.http}/metrics`, { headers: { 'X-Forwarded-For': '192.0.2.3' } });
  assert.match(await asked.text(), /refused_requests_total\{reason="request_rate"\} 2/);
});

test('what is no address of a proxy is refused at the start', () => {
  for (const trusted of ['everybody', '10.0.0.0/99', ''])
    assert.throws(() => createAddresses([trusted]), /--trust-proxy wants addresses like/, trusted);
  for (const trusted of ['loopback', '10.0.0.5', '2001:db8::/32']) assert.ok(createAddresses([trusted]));
});

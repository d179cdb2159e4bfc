import assert from 'node:assert/strict';
import { test } from 'node:test';
import { AddressGate } from '../address_gate.js';
import { addressKey } from '../addresses.js';
import { limitsWith } from '../limits.js';

const gateWith = (limits) => new AddressGate(limitsWith(limits));

test('what counts as one address: a /64 of IPv6, and IPv4 whichever way it comes', () => {
  for (const [text, key] of [
    ['192.0.2.7', '192.0.2.7'],
    ['::ffff:192.0.2.7', '192.0.2.7'],
    ['2001:db8:1:2:aaaa::1', '2001:db8:1:2::/64'],
    ['2001:0DB8:1:2::ffff', '2001:db8:1:2::/64'],
    ['::1', '::/64'],
    ['fe80::1%eth0', 'fe80::1%eth0'],
    ['unknown', undefined],
    ['', undefined],
    [undefined, undefined],
  ])
    assert.equal(addressKey(text), key, text);
});

test('an address may open some connections at once and some a second; others are not touched by it', () => {
  const gate = gateWith({ connectionRatePerAddress: { perSecond: 2, burst: 3 } });
  for (const connection of ['a', 'b', 'c']) assert.deepEqual(gate.connects('1', connection, 0), {});
  assert.deepEqual(gate.connects('1', 'd', 0), { refused: 'connection_rate' });
  assert.deepEqual(gate.connects('2', 'e', 0), {});
  assert.deepEqual(gate.connects('1', 'f', 500), {});
  assert.equal(gate.connections, 5);
});

test('abuse costs the connections to come, and is paid off', () => {
  const connectionRatePerAddress = { perSecond: 10, burst: 20 };
  const gate = gateWith({ connectionRatePerAddress, connectionsPerAbuse: 25 });
  assert.deepEqual(gate.connects('1', 'a', 0), {});
  gate.abuses('1', 0); // 19 - 25
  assert.ok('refused' in gate.connects('1', 'b', 600));
  assert.deepEqual(gate.connects('1', 'c', 700), {});
  for (let i = 0; i < 100; ++i) gate.abuses('1', 700); // -10: half of a burst is owed at most
  assert.ok('refused' in gate.connects('1', 'd', 1700));
  assert.deepEqual(gate.connects('1', 'e', 1800), {});
});

test('an address that has its share gives up its oldest connection, but no WebSocket', () => {
  const gate = gateWith({ maxConnectionsPerAddress: 3 });
  for (const connection of ['a', 'b', 'c']) gate.connects('1', connection, 0);
  gate.becomesWebSocket('1', 'a');
  assert.deepEqual(gate.connects('1', 'd', 0), { evicted: 'b', reason: 'address_connections' });
  gate.disconnects('1', 'b'); // its socket's end comes later, and is no second leave
  assert.equal(gate.connections, 3);
  gate.disconnects('1', 'd');
  assert.deepEqual(gate.connects('1', 'e', 0), {});
  for (const connection of ['c', 'e']) gate.becomesWebSocket('1', connection);
  assert.deepEqual(gate.connects('1', 'f', 0), { refused: 'address_connections' });
  assert.deepEqual(gate.connects('2', 'g', 0), {});
});

test('when all places are taken, whoever has most makes room for anybody', () => {
  const gate = gateWith({ maxTcpConnections: 4 });
  for (const [address, connection] of [
    ['1', 'a'],
    ['2', 'b'],
    ['2', 'c'],
    ['3', 'd'],
  ])
    gate.connects(address, connection, 0);
  assert.deepEqual(gate.connects('4', 'e', 0), { evicted: 'b', reason: 'tcp_connections' });
  assert.equal(gate.connections, 4);
  for (const [address, connection] of [
    ['1', 'a'],
    ['2', 'c'],
    ['3', 'd'],
    ['4', 'e'],
  ])
    gate.becomesWebSocket(address, connection);
  assert.deepEqual(gate.connects('5', 'f', 0), { refused: 'tcp_connections' });
});

test('a proxy has no share of its own, but its part in all', () => {
  const gate = gateWith({
    maxConnectionsPerAddress: 1,
    maxTcpConnections: 3,
    connectionRatePerAddress: { perSecond: 1, burst: 1 },
  });
  for (const connection of ['a', 'b', 'c']) assert.deepEqual(gate.connects('proxy', connection, 0, true), {});
  assert.equal(gate.connects('proxy', 'd', 0, true).evicted, 'a');
});

test('too many answers under way end the oldest', () => {
  const gate = gateWith({ maxAnswersPerAddress: 2 });
  assert.equal(gate.answers('1', 'a', 0), undefined);
  assert.equal(gate.answers('1', 'b', 0), undefined);
  assert.equal(gate.answers('1', 'c', 0), 'a');
  gate.answered('1', 'b');
  assert.equal(gate.answers('1', 'd', 0), undefined);
});

test('requests, upgrades, offers and clients are counted by address', () => {
  const once = { perSecond: 1, burst: 1 };
  const gate = gateWith({
    requestRatePerAddress: once,
    upgradeRatePerAddress: once,
    offerRatePerAddress: once,
    maxClientsPerAddress: 1,
  });
  for (const may of ['mayRequest', 'mayUpgrade', 'mayOffer'])
    assert.deepEqual(
      [gate[may]('1', 0), gate[may]('1', 0), gate[may]('2', 0), gate[may]('1', 1000)],
      [true, false, true, true],
      may,
    );
  gate.joins('1', 0);
  assert.deepEqual([gate.mayJoin('1', 0), gate.mayJoin('2', 0)], [false, true]);
  gate.leaves('1');
  assert.equal(gate.mayJoin('1', 0), true);
});

test('who lets an address have more clients lets them come', () => {
  const more = limitsWith({ maxClientsPerAddress: 320, requestRatePerAddress: { perSecond: 1, burst: 1 } });
  assert.deepEqual(more.upgradeRatePerAddress, { perSecond: 100, burst: 640 });
  assert.deepEqual([more.maxClientsPerAddress, more.maxConnectionsPerAddress], [320, 2560]);
  assert.equal(more.requestRatePerAddress.burst, 1, 'what is given itself stays');
  assert.deepEqual(limitsWith({ maxClientsPerAddress: 1 }), { ...limitsWith(), maxClientsPerAddress: 1 });
});

test('addresses that are gone are forgotten, when their rates are good again or when there are too many', () => {
  const gate = gateWith({ maxAddresses: 3 });
  gate.connects('1', 'a', 0);
  gate.mayRequest('2', 0);
  gate.forget(0);
  assert.equal(gate.addresses, 2);
  gate.forget(60_000);
  assert.equal(gate.addresses, 1, 'the one that is connected');
  gate.disconnects('1', 'a');
  gate.forget(60_000);
  assert.equal(gate.addresses, 0);

  gate.connects('busy', 'a', 0);
  for (let i = 0; i < 1000; ++i) gate.mayRequest(`${i}`, 0);
  assert.equal(gate.addresses, 3);
  gate.disconnects('busy', 'a');
  assert.equal(gate.connections, 0);
});

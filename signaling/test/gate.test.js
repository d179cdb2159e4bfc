import assert from 'node:assert/strict';
import { test } from 'node:test';
import { createAddressFinder, visitorOf } from '../addresses.js';
import { Gate } from '../gate.js';
import { defaultLimits } from '../limits.js';

const limits = {
  ...defaultLimits,
  maxConnectionsPerAddress: 3,
  maxClientsPerAddress: 2,
  arrivalRate: { perSecond: 1, burst: 5 },
  requestRate: { perSecond: 10, burst: 20 },
  joinRate: { perSecond: 1, burst: 2 },
  visitorMemoryMs: 1000,
};

/** A connection that notes its end. */
const connection = () => {
  const made = { ended: false, destroy: () => (made.ended = true) };
  return made;
};

test('the oldest connection of an address makes place, but never a WebSocket, and nobody else pays', () => {
  const gate = new Gate(limits);
  const [other, webSocket, old, young, anew] = Array.from({ length: 5 }, connection);
  gate.connects('b', 'b1', other, 0);
  gate.connects('a', '1', webSocket, 0);
  gate.upgrades('a', '1');
  gate.connects('a', '2', old, 0);
  gate.connects('a', '3', young, 0);
  assert.deepEqual(gate.connects('a', '4', anew, 0), { evicted: 'connections' });
  assert.deepEqual(
    [webSocket, old, young, anew, other].map(({ ended }) => ended),
    [false, true, false, false, false],
  );
  gate.upgrades('a', '3');
  gate.upgrades('a', '4');
  assert.deepEqual(gate.connects('a', '5', connection(), 0), { refused: 'connections' });
});

test('connections, requests and attempts to join are limited a second, each address by itself', () => {
  const gate = new Gate(limits);
  const count = (ask) => Array.from({ length: 100 }, ask).filter(Boolean).length;
  assert.equal(
    count((_, n) => !gate.connects('a', `${n}`, connection(), 0).refused),
    5,
  );
  assert.equal(
    count(() => gate.requests('a', 0)),
    20,
  );
  assert.equal(
    count(() => gate.requests('a', 1000)),
    10,
  );
  assert.equal(
    count(() => gate.joins('a', 0)),
    2,
  );
  assert.equal(gate.joins('b', 0), true);
});

test('places of clients are given back', () => {
  const gate = new Gate(limits);
  assert.deepEqual(
    [1, 2, 3].map(() => gate.enters('a', 0)),
    [true, true, false],
  );
  gate.leaves('a');
  assert.equal(gate.enters('a', 0), true);
});

test('an address that has gone is forgotten', () => {
  const gate = new Gate(limits);
  for (let n = 0; n < 1000; ++n) {
    gate.connects(`${n}`, 'only', connection(), 0);
    if (n > 0) gate.disconnects(`${n}`, 'only');
  }
  gate.forget(500);
  assert.equal(gate.size, 1000);
  gate.forget(1500);
  assert.equal(gate.size, 1, 'one is still connected');
});

test('IPv4 is one visitor however it is written, an IPv6 network is one', () => {
  assert.equal(visitorOf('::ffff:10.1.2.3'), '10.1.2.3');
  assert.equal(visitorOf('2001:db8:1:2:3:4:5:6'), visitorOf('2001:db8:1:2:ffff::1'));
  assert.notEqual(visitorOf('2001:db8:1:2::1'), visitorOf('2001:db8:1:3::1'));
  assert.equal(visitorOf(undefined), 'unknown');
});

test('X-Forwarded-For counts from a proxy that is trusted, and its last untrusted address', () => {
  const request = (remoteAddress, forwarded) =>
    /** @type {any} */ ({
      socket: { remoteAddress },
      connection: { remoteAddress },
      headers: { 'x-forwarded-for': forwarded },
    });
  const { visitor, isProxy } = createAddressFinder(['loopback']);
  assert.equal(visitor(request('127.0.0.1', '198.51.100.1, 203.0.113.5')), '203.0.113.5');
  assert.equal(visitor(request('203.0.113.9', '198.51.100.1')), '203.0.113.9', 'anybody can write a header');
  assert.deepEqual([isProxy('127.0.0.1'), isProxy('203.0.113.9')], [true, false]);
  assert.equal(createAddressFinder([]).visitor(request('127.0.0.1', '203.0.113.5')), '127.0.0.1');
  assert.throws(() => createAddressFinder(['no address']), TypeError);
});

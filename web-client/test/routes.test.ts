import assert from 'node:assert/strict';
import { test } from 'node:test';
import { kindOf, Routes } from '../src/routes';

const host = 'candidate:1 1 UDP 2122317823 192.168.0.7 56143 typ host';
const reflexive = 'candidate:2 1 udp 1686052607 203.0.113.9 40001 typ srflx raddr 0.0.0.0 rport 0';
const relay = 'candidate:3 1 udp 41885439 203.0.113.1 50000 typ relay raddr 203.0.113.9 rport 40001';

test('the kind of a candidate is read from its line', () => {
  assert.deepEqual([host, reflexive, relay].map(kindOf), ['host', 'srflx', 'relay']);
  assert.equal(kindOf('candidate:1 1 UDP 1 10.0.0.1 9 typ wormhole'), undefined);
  assert.equal(kindOf(''), undefined);
});

test('a failure names the kinds of both sides and what to try', () => {
  const routes = new Routes(false);
  routes.addOwn(host);
  routes.addOwn(reflexive);
  routes.addTheirs(`v=0\r\na=${host}\r\n`);
  const text = routes.describeFailure();
  assert.match(text, /This browser offered its own address \(host\) and its router's address \(srflx\)/);
  assert.match(text, /the server its own address \(host\)/);
  assert.match(text, /another network.*TURN server/);
});

test('the advice fits what is missing', () => {
  const advice = (own: string[], theirs: string[], hasTurn = false): string => {
    const routes = new Routes(hasTurn);
    own.forEach((line) => routes.addOwn(line));
    theirs.forEach((line) => routes.addTheirs(line));
    return routes.describeFailure();
  };
  assert.match(advice([], [host]), /no address at all.*keeps WebRTC back/);
  assert.match(advice([host], []), /the server no address at all.*did not answer/);
  assert.match(advice([host, relay], [host], true), /Even the relay/);
  assert.match(advice([host], [host], true), /relay \(TURN\) did not answer/);
});

// Players and render server at home, behind routers.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { launch } from './browser.js';
import { internet, makeInternet } from './networks.js';
import { signaling } from './programs.js';
import { startTurn } from './turn.js';

const metrics = async (url) => (await fetch(`${url}/metrics`)).text();

/** How often a pair of these kinds has found each other, the server's first; by the render server's report. */
async function pairs(url) {
  const found = {};
  for (const [, kinds, count] of (await metrics(url)).matchAll(/counted_total\{what="pair_(\w+)"\} (\d+)/g))
    found[kinds] = Number(count);
  return found;
}

/** A page that only takes a relay's addresses. */
const relayOnly = () => {
  const Whole = window.RTCPeerConnection;
  window.RTCPeerConnection = class extends Whole {
    constructor(options) {
      super({ ...options, iceTransportPolicy: 'relay' });
    }
  };
};

/** A room on the internet with its render server in a home of its own, or beside signaling. */
async function makeRoom(t, { nat = 'cone', turn = false, stun = true, serverAtHome = true, serve = [] }) {
  const net = makeInternet(t);
  const relay = await startTurn(t, internet);
  const options = [
    ...(stun ? ['--ice-server', relay.stun] : []),
    ...(turn ? ['--ice-server', relay.turn] : []),
  ];
  const secret = ['--turn-secret-file', relay.secretFile];
  const home = serverAtHome ? net.home(nat) : undefined;
  const room = await signaling(t, {
    host: internet,
    options: [...options, ...secret],
    servePrefix: home?.prefix,
  });
  const server = room.serve(...serve);
  return { url: room.url, net, relay, server };
}

/** Two players in homes of their own, both lit. */
async function twoPlayers(t, { url, net }, nat, init) {
  const players = [];
  for (let i = 0; i < 2; ++i) {
    const browser = await launch(t, net.home(nat).prefix);
    players.push(await browser.open(url, { init }));
    await players[i].lit(40_000);
  }
  return players;
}

/** Each moves its cube, and the other sees it. */
async function playTogether(players) {
  const [one, two] = players;
  for (const [mover, watcher] of [
    [one, two],
    [two, one],
  ]) {
    const { role, places } = await mover.knows();
    const cube = role.cube - 1;
    assert.ok(cube >= 0, 'a player has a cube');
    await mover.press('ArrowUp', (known) => known.places[cube].y > places[cube].y);
    await watcher.until('it sees the move', (known) => known.places[cube].y > places[cube].y);
  }
}

test('three symmetric NATs: through coturn', async (t) => {
  const room = await makeRoom(t, { nat: 'symmetric', turn: true });
  const players = await twoPlayers(t, room, 'symmetric');
  await playTogether(players);
  await players[0].screenshot('through-coturn');
  const found = await pairs(room.url);
  assert.ok(
    Object.keys(found).every((kinds) => kinds.includes('relay') || kinds.includes('prflx')),
    JSON.stringify(found),
  );
});

test('cone NATs: with STUN alone', async (t) => {
  const room = await makeRoom(t, { nat: 'cone' });
  await playTogether(await twoPlayers(t, room, 'cone'));
  const found = await pairs(room.url);
  assert.ok(
    Object.keys(found).every((kinds) => !kinds.includes('relay')),
    JSON.stringify(found),
  );
});

test("pages that only take a relay's addresses", async (t) => {
  const room = await makeRoom(t, { nat: 'cone', turn: true });
  await playTogether(await twoPlayers(t, room, 'symmetric', relayOnly));
  const found = await pairs(room.url);
  assert.ok(
    Object.keys(found).every((kinds) => /_(relay|prflx)$/.test(kinds)),
    JSON.stringify(found),
  );
});

test('one open UDP port: symmetric NATs reach it without TURN', async (t) => {
  const room = await makeRoom(t, { serverAtHome: false, serve: ['--udp-port', '40000'] });
  await playTogether(await twoPlayers(t, room, 'symmetric'));
  assert.deepEqual(
    Object.keys(await pairs(room.url)).filter((kinds) => !kinds.startsWith('host_')),
    [],
  );
});

test('coturn is gone: the page says which addresses both sides had, and what to try', async (t) => {
  const room = await makeRoom(t, { nat: 'symmetric', turn: true });
  room.relay.program.child.kill('SIGTERM');
  await room.relay.program.exited;
  const browser = await launch(t, room.net.home('symmetric').prefix);
  const player = await browser.open(room.url);
  const { error } = await player.until('told', ({ state }) => state === 'lost', 60_000);
  assert.match(
    error,
    /no way to the render server was found\. This browser offered its own address \(host\)/,
  );
  assert.match(error, /the server its own address \(host\)/);
  assert.match(error, /try another network.*TURN server/);
  assert.match(await player.page.locator('#trouble').innerText(), /no way to the render server/i);
  await player.screenshot('no-way');
  const counted = async () => /what="connect_failed_no_pair"\} [1-9]/.test(await metrics(room.url));
  for (let i = 0; !(await counted()); ++i) {
    assert.ok(i < 30, 'the failure is not counted');
    await new Promise((proceed) => setTimeout(proceed, 100));
  }
});

// Players and render server at home, behind routers.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { test } from 'node:test';
import { launch } from './browser.js';
import { internet, makeInternet, ownAddress } from './networks.js';
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

/** A room on the internet, its render server in a home of its own. */
async function makeRoom(t, { nat, turn = false }) {
  const net = makeInternet(t);
  const relay = await startTurn(t, internet);
  const { url, serve } = await signaling(t, {
    host: internet,
    options: [
      ...['--ice-server', relay.stun],
      ...(turn ? ['--ice-server', relay.turn, '--turn-secret-file', relay.secretFile] : []),
    ],
    servePrefix: net.home(nat).prefix,
  });
  serve();
  return { url, net, relay };
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

test('the NATs are what they are called', async (t) => {
  const net = makeInternet(t);
  ownAddress('203.0.113.2');
  await startTurn(t, internet, ['203.0.113.2']);
  for (const [nat, finding] of /** @type {const} */ ([
    ['symmetric', /NAT with Address and Port Dependent Mapping!/],
    ['cone', /NAT with Endpoint Independent Mapping!/],
  ])) {
    const [command, ...args] = [...net.home(nat).prefix, 'turnutils_natdiscovery', '-m', internet];
    assert.match(execFileSync(command, args, { encoding: 'utf8' }), finding);
  }
});

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

test('one open UDP port: symmetric NATs reach it without STUN and TURN', async (t) => {
  const net = makeInternet(t);
  const { url, serve } = await signaling(t, { host: internet });
  serve('--udp-port', '40000');
  const players = [];
  for (let i = 0; i < 3; ++i) {
    const home = net.home('symmetric');
    home.block('iifname lan udp dport != 40000');
    const browser = await launch(t, home.prefix);
    players.push(await browser.open(url));
    await players[i].lit(40_000);
  }
  await playTogether(players);
  assert.deepEqual(
    Object.keys(await pairs(url)).filter((kinds) => !kinds.startsWith('host_')),
    [],
  );
});

test('behind a 1:1 NAT the render server is reached by the address that it is told', async (t) => {
  const net = makeInternet(t);
  const machine = net.home('oneToOne');
  const { url, serve } = await signaling(t, { host: internet, servePrefix: machine.prefix });
  serve('--public-ip', machine.address);
  await playTogether(await twoPlayers(t, { url, net }, 'symmetric'));
});

/**
 * What a player behind a symmetric NAT is told once it has given up; looked at on the page, which shows it between two
 * attempts. The render server counts it under this name.
 */
async function failure(t, room, counted) {
  const browser = await launch(t, room.net.home('symmetric').prefix);
  const player = await browser.open(room.url);
  const told = player.page.locator('#trouble-text').filter({ hasText: 'This browser offered' });
  await told.waitFor({ timeout: 60_000 });
  const text = await told.innerText();
  await player.screenshot(counted);
  for (let i = 0; !new RegExp(`what="${counted}"\\} [1-9]`).test(await metrics(room.url)); ++i) {
    assert.ok(i < 30, `${counted} is not counted`);
    await new Promise((proceed) => setTimeout(proceed, 100));
  }
  return text;
}

test('STUN alone is not enough for symmetric NATs: the page says which addresses both sides had, and what to try', async (t) => {
  const room = await makeRoom(t, { nat: 'symmetric' });
  const text = await failure(t, room, 'connect_failed_no_pair');
  const both = String.raw`its own address \(host\) and its router's address \(srflx\)`;
  assert.match(text, new RegExp(`This browser offered ${both}, the server ${both}\\.`));
  assert.match(text, /try another network.*TURN server/);
});

test('coturn is gone: likewise', async (t) => {
  const room = await makeRoom(t, { nat: 'symmetric', turn: true });
  room.relay.program.child.kill('SIGTERM');
  await room.relay.program.exited;
  // The browser's own address stands behind a name (.local), which is none to the render server.
  const text = await failure(t, room, 'connect_failed_no_candidates');
  assert.match(text, /This browser offered its own address \(host\), the server its own address \(host\)\./);
  assert.match(text, /relay \(TURN\) did not answer/);
});

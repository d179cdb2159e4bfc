// What one address can do to all others. Signaling is a program of its own here, so that it may die; the attacker comes
// from 127.0.0.2, and is tried from the good client's own address, too.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { get } from 'node:http';
import { connect } from 'node:net';
import { join } from 'node:path';
import { test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import { WebSocket } from 'ws';
import { Peer, makeSite } from './harness.js';

const main = fileURLToPath(new URL('../main.js', import.meta.url));
const mebi = 1024 * 1024;

/** Signaling with a page of 700 kB and a scene of 8 MiB. */
async function startProgram(t) {
  const site = makeSite(t);
  mkdirSync(join(site.client, 'assets'));
  writeFileSync(join(site.client, 'assets/index.js'), Buffer.alloc(700_000, '/'));
  writeFileSync(site.scene, Buffer.concat([Buffer.from('glTF'), Buffer.alloc(8 * mebi)]));
  const args = ['--port', '0', '--token-file', site.token, '--client', site.client, '--scene', site.scene];
  const child = spawn(process.execPath, [main, ...args], { stdio: ['ignore', 'pipe', 'pipe'] });
  t.after(() => child.kill('SIGKILL'));
  let log = '';
  child.stderr.on('data', (data) => (log += data));
  const [line] = await once(child.stdout, 'data');
  const port = Number(/:(\d+)\n/.exec(String(line))?.[1]);
  const status = () => readFileSync(`/proc/${child.pid}/status`, 'utf8');
  return {
    port,
    ws: `ws://127.0.0.1:${port}`,
    lives: () => child.exitCode === null && child.signalCode === null,
    memory: () => (Number(/VmRSS:\s+(\d+)/.exec(status())?.[1]) * 1024) / mebi,
    files: () => readdirSync(`/proc/${child.pid}/fd`).length,
    logLines: () => log.split('\n').length,
  };
}

/** Loads the page as a browser does, and joins: milliseconds. */
async function visit(program) {
  const begin = performance.now();
  for (const path of ['/', '/assets/index.js'])
    await new Promise((settle, fail) => {
      const request = get({ port: program.port, host: '127.0.0.1', path, agent: false }, (response) => {
        response.resume();
        response.on('end', () =>
          response.statusCode === 200 ? settle(undefined) : fail(new Error(`HTTP ${response.statusCode}`)),
        );
        response.on('error', fail);
      });
      request.on('error', fail);
    });
  const client = Peer.client(program.ws);
  assert.equal((await client.next()).type, 'welcome');
  client.socket.terminate();
  return performance.now() - begin;
}

const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

async function visits(program, count) {
  const times = [];
  for (let i = 0; i < count; ++i) {
    times.push(await visit(program));
    await sleep(30);
  }
  return median(times);
}

const request = (path, more = '') => `GET ${path} HTTP/1.1\r\nHost: 127.0.0.1\r\n${more}\r\n`;

/** Connections that stay as they are; whatever becomes of them. */
function open(program, from, count, onConnect) {
  return Array.from({ length: count }, () => {
    const socket = connect({ port: program.port, host: '127.0.0.1', localAddress: from });
    socket.on('error', () => {});
    socket.on('connect', () => onConnect(socket));
    return socket;
  });
}

const attacks = {
  'requests in one go, thousands a connection': (program, from) =>
    open(program, from, 5, (socket) => {
      socket.pause();
      socket.write(request('/').repeat(5000));
    }),
  'answers that nobody reads': (program, from) =>
    open(program, from, 1100, (socket) => {
      socket.pause();
      socket.write(request('/scene.glb'));
    }),
  'headers that never end': (program, from) =>
    open(program, from, 1100, (socket) => socket.write('GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Slow: ')),
  'coming again and again': (program, from) => {
    let ended = false;
    const sockets = [];
    const again = () => {
      if (ended) return;
      const socket = connect({ port: program.port, host: '127.0.0.1', localAddress: from });
      sockets.push(socket);
      socket.on('error', () => {});
      socket.write(request('/elsewhere', 'Connection: Upgrade\r\nUpgrade: websocket\r\n'));
      socket.on('close', again);
    };
    for (let i = 0; i < 20; ++i) again();
    sockets.push(/** @type {any} */ ({ destroy: () => (ended = true) }));
    return sockets;
  },
  'more WebSockets than anybody needs': (program, from) =>
    Array.from({ length: 300 }, () => {
      const socket = new WebSocket(`${program.ws}/client`, { localAddress: from });
      socket.on('error', () => {});
      return /** @type {any} */ ({ destroy: () => socket.terminate() });
    }),
};

for (const [name, attack] of Object.entries(attacks)) {
  test(`${name}: others do not notice`, { timeout: 60_000 }, async (t) => {
    const program = await startProgram(t);
    await visits(program, 5); // what is compiled and kept at first use does not count
    const [quiet, memory, files] = [await visits(program, 15), program.memory(), program.files()];
    const sockets = attack(program, '127.0.0.2');
    t.after(() => sockets.forEach((socket) => socket.destroy()));
    await sleep(300);
    const attacked = await visits(program, 15);
    const most = program.memory();
    sockets.forEach((socket) => socket.destroy());
    for (let i = 0; i < 100 && program.files() > files; ++i) await sleep(100);
    t.diagnostic(
      `a visit took ${quiet.toFixed(1)} ms, ${attacked.toFixed(1)} under attack; memory ${memory.toFixed(0)} MiB, ` +
        `${most.toFixed(0)} under attack, ${program.memory().toFixed(0)} after; ${program.logLines()} lines of log`,
    );
    assert.ok(program.lives());
    assert.ok(attacked < 10 * quiet + 100, `visits take ${attacked} ms instead of ${quiet}`);
    assert.ok(most < memory + 150, `${most} MiB of memory, ${memory} before`);
    assert.equal(program.files(), files);
    assert.ok(program.logLines() < 150, 'the log is not filled');
  });
}

test("the attacker's own address recovers while the attack hangs on", { timeout: 120_000 }, async (t) => {
  for (const name of [
    'requests in one go, thousands a connection',
    'answers that nobody reads',
    'headers that never end',
  ]) {
    const program = await startProgram(t);
    const sockets = attacks[name](program, '127.0.0.1');
    t.after(() => sockets.forEach((socket) => socket.destroy()));
    const begin = performance.now();
    while (
      !(await visit(program).then(
        () => true,
        () => false,
      ))
    ) {
      assert.ok(performance.now() - begin < 20_000, `${name}: nobody gets in`);
      await sleep(200);
    }
    t.diagnostic(`${name}: in again after ${((performance.now() - begin) / 1000).toFixed(1)} s`);
    assert.ok(program.lives());
  }
});

test(
  'half-sent headers and idle connections go in the time that is promised',
  { timeout: 60_000 },
  async (t) => {
    const program = await startProgram(t);
    const began = performance.now();
    const [slow] = open(program, '127.0.0.2', 1, (socket) => socket.resume().write('GET / HTTP/1.1\r\nX: '));
    const [unread] = open(program, '127.0.0.2', 1, (socket) => {
      socket.pause();
      socket.write(request('/scene.glb'));
    });
    const gone = (socket) =>
      new Promise((settle) => socket.once('close', () => settle(performance.now() - began)));
    const slowGone = await gone(slow);
    assert.ok(slowGone < 13_000, `headers were waited for during ${slowGone} ms`);
    const left = program.files();
    while (program.files() >= left) {
      assert.ok(performance.now() - began < 25_000, 'an answer that nobody reads is kept');
      await sleep(200);
    }
    unread.destroy();
  },
);

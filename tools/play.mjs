#!/usr/bin/env node
/**
 * Runs a room on this machine: signaling with the web client, and the render server. Prints `ready http://HOST:PORT`
 * once a player can join; everything else goes to stderr. Ends both when it is ended or when one of them dies.
 *
 *   node tools/play.mjs [--host 127.0.0.1] [--port 8080] [--scene assets/cornell.glb] [-- SERVE OPTIONS]
 *
 * --host is a name or address of this machine, for the page and for WebRTC; 0.0.0.0 or :: takes every address (WebRTC
 * then uses all but the loopback ones).
 *
 * LICHTVELD names another render server than build/release/lichtveld. Exit codes: 0 ended by a signal, 2 bad usage or
 * input (a busy port, say), else the code of the program that died.
 */
import { spawn } from 'node:child_process';
import { randomBytes } from 'node:crypto';
import { lookup } from 'node:dns/promises';
import { existsSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { createInterface } from 'node:readline';
import { setTimeout as sleep } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

const root = dirname(dirname(fileURLToPath(import.meta.url)));
/** Milliseconds between SIGTERM and SIGKILL. */
const patience = 5000;

const say = (text) => process.stderr.write(`play: ${text}\n`);

async function readOptions() {
  const split = process.argv.indexOf('--');
  const own = process.argv.slice(2, split < 0 ? undefined : split);
  const serveOptions = split < 0 ? [] : process.argv.slice(split + 1);
  const { values } = parseArgs({
    args: own,
    options: {
      host: { type: 'string', default: '127.0.0.1' },
      port: { type: 'string', default: '8080' },
      scene: { type: 'string', default: join(root, 'assets/cornell.glb') },
    },
  });
  if (!/^\d{1,5}$/.test(values.port) || Number(values.port) < 1 || Number(values.port) > 65535)
    throw new Error(`--port wants a number from 1 to 65535, not '${values.port}'`);
  const executable = resolve(process.env.LICHTVELD || join(root, 'build/release/lichtveld'));
  for (const [path, hint] of [
    [executable, 'build it with ./dev build'],
    [values.scene, 'give another with --scene'],
    [join(root, 'web-client/dist/index.html'), 'build it with npm run build --workspace web-client'],
  ])
    if (!existsSync(path)) throw new Error(`${path} is missing: ${hint}`);
  const host = values.host || '0.0.0.0';
  // One address for all: WebRTC binds to no name, and a name may have several addresses.
  const { address } = await lookup(host, { verbatim: false }).catch((error) => {
    throw new Error(`--host ${host} is no known host (${error.code}): give an address of this machine`);
  });
  return { ...values, host, address, executable, serveOptions };
}

/** Where somebody on this machine reaches what listens on `host`. */
function urlHost(host) {
  if (host === '0.0.0.0') return '127.0.0.1';
  if (host === '::') return '[::1]';
  return host.includes(':') ? `[${host}]` : host;
}

/** The programs that run; ends with `finish`, whatever happens. */
class Company {
  #members = new Map();
  #folder = mkdtempSync(join(tmpdir(), 'lichtveld-play-'));
  #finishing = false;

  get finishing() {
    return this.#finishing;
  }

  /** A fresh secret that only we can read. */
  writeToken() {
    const path = join(this.#folder, 'token');
    writeFileSync(path, `${randomBytes(32).toString('hex')}\n`, { mode: 0o600 });
    return path;
  }

  start(name, command, args, onLine = (_line) => {}) {
    // A group of its own: Ctrl-C reaches us alone, and we end the others in order.
    const child = spawn(command, args, { detached: true, stdio: ['ignore', 'pipe', 'pipe'] });
    const gone = new Promise((settle) => {
      child.once('error', (error) => settle({ code: 1, why: `could not be started: ${error.message}` }));
      child.once('exit', (code, signal) =>
        settle({ code: code ?? 1, why: signal ? `was ended by ${signal}` : `ended with exit code ${code}` }),
      );
    });
    this.#members.set(name, { child, gone });
    for (const stream of [child.stdout, child.stderr])
      createInterface({ input: stream }).on('line', (line) => {
        process.stderr.write(`[${name}] ${line}\n`);
        onLine(line);
      });
    gone.then(({ code, why }) => {
      if (this.#finishing) return;
      say(`${name} ${why}; ending the rest`);
      this.finish(code || 1);
    });
  }

  async finish(code) {
    if (this.#finishing) return;
    this.#finishing = true;
    const members = [...this.#members.values()];
    const all = Promise.all(members.map(({ gone }) => gone));
    this.#signal('SIGTERM');
    const done = await Promise.race([all.then(() => true), sleep(patience, false, { ref: false })]);
    if (!done) {
      this.#signal('SIGKILL');
      await all;
    }
    this.removeFiles();
    process.exit(code);
  }

  #signal(signal) {
    for (const { child } of this.#members.values())
      if (child.pid !== undefined && child.exitCode === null && child.signalCode === null)
        process.kill(-child.pid, signal);
  }

  removeFiles() {
    rmSync(this.#folder, { recursive: true, force: true });
  }
}

/** Waits until a render server is with signaling; false when we are ending instead. */
async function untilServed(company, url) {
  while (!company.finishing) {
    const health = await fetch(`${url}/healthz`, { signal: AbortSignal.timeout(2000) }).then(
      (r) => r.json(),
      () => undefined,
    );
    if (health?.server) return true;
    await sleep(100);
  }
  return false;
}

let options;
try {
  options = await readOptions();
} catch (error) {
  say(error.message);
  process.exit(2);
}

const company = new Company();
process.on('exit', () => company.removeFiles());
for (const signal of ['SIGINT', 'SIGTERM', 'SIGHUP']) process.on(signal, () => company.finish(0));

const { host, address, port, scene, executable, serveOptions } = options;
const token = company.writeToken();
const authority = `${urlHost(host)}:${port}`;
const client = join(root, 'web-client/dist');
// Only its own word counts: whatever answers on that port may be somebody else's.
await new Promise((listening) => {
  const args = [
    '--host',
    address,
    '--port',
    port,
    '--token-file',
    token,
    '--client',
    client,
    '--scene',
    resolve(scene),
  ];
  company.start('signaling', process.execPath, [join(root, 'signaling/main.js'), ...args], (line) => {
    if (line.startsWith('signaling listens on')) listening(undefined);
  });
});
const args = [
  '--scene',
  resolve(scene),
  '--signaling',
  `ws://${authority}/server`,
  '--token-file',
  token,
  '--bind',
  address,
];
company.start('server', executable, ['serve', ...args, ...serveOptions]);
if (await untilServed(company, `http://${authority}`)) console.log(`ready http://${authority}`);

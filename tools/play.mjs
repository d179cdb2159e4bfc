#!/usr/bin/env node
/**
 * Runs a room on this machine: signaling with the web client, and the render server. Prints `ready http://HOST:PORT`
 * once a player can join; everything else goes to stderr. A program that ends unasked is started again; when that is of
 * no use, or a signal comes, all are ended.
 *
 *   node tools/play.mjs [--host 127.0.0.1] [--port 8080] [--scene assets/room.glb] [--public] [-- SERVE OPTIONS]
 *
 * --host is a name or address of this machine, for the page and for WebRTC; 0.0.0.0 or :: takes every address (WebRTC
 * then uses all but the loopback ones).
 *
 * --public is for a machine that the internet reaches: it listens on every address, lets in only those who have a link
 * with a token, takes one UDP port (the page's number) for the light, and runs a coturn beside it. --public-ip names the
 * address where a 1:1 NAT stands before the machine. Options of signaling may be given too: --name, --tls-cert,
 * --tls-key, --join-secret-file, --trust-proxy, --ice-server, --turn-secret-file, --allow-origin, --max-clients,
 * --max-per-address.
 *
 * LICHTVELD names another render server than build/release/lichtveld. Exit codes: 0 ended by a signal, 2 bad usage or
 * input (a busy port, say), else the code of the program that died.
 */
import { execFileSync, spawnSync } from 'node:child_process';
import { randomBytes } from 'node:crypto';
import { lookup } from 'node:dns/promises';
import { existsSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { get as getHttp } from 'node:http';
import { get as getHttps } from 'node:https';
import { isIP } from 'node:net';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { Company } from './play/company.mjs';
import { iceServers, publicAddress, writeTurnConfiguration } from './play/public.mjs';

const root = dirname(dirname(fileURLToPath(import.meta.url)));
const signalingMain = join(root, 'signaling/main.js');
const linkMain = join(root, 'signaling/link.js');

/** Options of signaling that are passed on as they are. */
const signalingOptions = /** @type {const} */ ({
  name: { type: 'string', multiple: true },
  'tls-cert': { type: 'string' },
  'tls-key': { type: 'string' },
  'join-secret-file': { type: 'string' },
  'trust-proxy': { type: 'string', multiple: true },
  'ice-server': { type: 'string', multiple: true },
  'turn-secret-file': { type: 'string' },
  'allow-origin': { type: 'string', multiple: true },
  'max-clients': { type: 'string' },
  'max-per-address': { type: 'string' },
});

const say = (text) => process.stderr.write(`play: ${text}\n`);

async function readOptions() {
  const split = process.argv.indexOf('--');
  const own = process.argv.slice(2, split < 0 ? undefined : split);
  const serveOptions = split < 0 ? [] : process.argv.slice(split + 1);
  const { values } = parseArgs({
    args: own,
    options: {
      host: { type: 'string' },
      port: { type: 'string', default: '8080' },
      scene: { type: 'string', default: join(root, 'assets/room.glb') },
      public: { type: 'boolean', default: false },
      'public-ip': { type: 'string' },
      ...signalingOptions,
    },
  });
  if (!/^\d{1,5}$/.test(values.port) || Number(values.port) < 1 || Number(values.port) > 65535)
    throw new Error(`--port wants a number from 1 to 65535, not '${values.port}'`);
  if (values['public-ip'] !== undefined && !values.public)
    throw new Error('--public-ip is for --public: add that');
  const executable = resolve(process.env.LICHTVELD || join(root, 'build/release/lichtveld'));
  for (const [path, hint] of [
    [executable, 'build it with ./dev build'],
    [values.scene, 'give another with --scene'],
    [join(root, 'web-client/dist/index.html'), 'build it with npm run build --workspace web-client'],
  ])
    if (!existsSync(path)) throw new Error(`${path} is missing: ${hint}`);
  const host = (values.host ?? (values.public ? '0.0.0.0' : '127.0.0.1')) || '0.0.0.0';
  // One address for all: WebRTC binds to no name, and a name may have several addresses.
  const { address } = await lookup(host, { verbatim: false }).catch((error) => {
    throw new Error(`--host ${host} is no known host (${error.code}): give an address of this machine`);
  });
  if (values['tls-cert'] && !values.name)
    throw new Error(
      '--tls-cert wants --name too: the name in the certificate, by which the render server calls',
    );
  const seenFromOutside = values.public ? publicAddress(values['public-ip']) : undefined;
  return { ...values, host, address, executable, serveOptions, seenFromOutside };
}

/** Where somebody on this machine reaches what listens on `host`. */
function urlHost(host) {
  if (host === '0.0.0.0') return '127.0.0.1';
  if (host === '::') return '[::1]';
  return host.includes(':') ? `[${host}]` : host;
}

/** A secret in a file that only we can read. */
function writeSecret(folder, name) {
  const path = join(folder, name);
  const secret = randomBytes(32).toString('hex');
  writeFileSync(path, `${secret}\n`, { mode: 0o600 });
  return { path, secret };
}

/** Signaling's arguments among ours, as they were given. */
const passedOn = (options) =>
  Object.keys(signalingOptions).flatMap((name) =>
    [options[name] ?? []].flat().flatMap((value) => [`--${name}`, value]),
  );

/** Starts a TURN server, and answers with the arguments by which signaling hands it out. */
function startTurn(company, folder, address) {
  try {
    execFileSync('turnserver', ['--version'], { stdio: 'ignore' });
  } catch (error) {
    if (error.code === 'ENOENT')
      throw new Error(
        '--public needs coturn: install it (apt install coturn), or give your own server with --ice-server',
      );
  }
  const { path, secret } = writeSecret(folder, 'turn-secret');
  company.start('coturn', 'turnserver', ['-c', writeTurnConfiguration({ folder, secret, address })]);
  return ['--turn-secret-file', path, ...iceServers(address.address).flatMap((url) => ['--ice-server', url])];
}

/** Waits until a render server is with signaling; false when we are ending instead. */
async function untilServed(company, url) {
  // Our own process on our own port: the certificate is another name's.
  const options = { rejectUnauthorized: false, timeout: 2000 };
  const health = () =>
    new Promise((settle) => {
      const request = (url.startsWith('https:') ? getHttps : getHttp)(
        `${url}/healthz`,
        options,
        (response) => {
          let text = '';
          response.on('data', (chunk) => (text += chunk));
          response.on('end', () => settle(text));
        },
      );
      request.on('timeout', () => request.destroy());
      request.on('error', () => settle(''));
    });
  while (!company.finishing) {
    if ((await health()).includes('"server":true')) return true;
    await sleep(100);
  }
  return false;
}

/** Links for those who may join; on a terminal only, as whoever reads a log could join, too. */
function showLinks(secretFile, url) {
  const link = (role) => {
    const args = [linkMain, '--join-secret-file', secretFile, '--url', url, '--role', role];
    if (process.stdout.isTTY) return execFileSync(process.execPath, args, { encoding: 'utf8' }).trim();
    return `node ${args.join(' ')}`;
  };
  say(process.stdout.isTTY ? 'links, good for a day:' : 'make links for those who may join with:');
  for (const role of ['player', 'watcher']) process.stderr.write(`  ${role}  ${link(role)}\n`);
}

/** The scene as one file that browsers draw, with an atlas for its light map: made where its own cannot be used. */
function withAtlas(scene, { executable, serveOptions }, folder) {
  const made = join(folder, 'scene.glb');
  const size = serveOptions.flatMap((option, at) =>
    option === '--size' ? [option, serveOptions[at + 1] ?? ''] : option.startsWith('--size=') ? [option] : [],
  );
  const { status, signal } = spawnSync(executable, ['unwrap', scene, '--out', made, ...size], {
    stdio: ['ignore', 2, 2],
  });
  if (status === 0) return made;
  say(`the scene cannot be used${signal ? `: unwrap was ended by ${signal}` : ''}`);
  process.exit(status ?? 1);
}

let options;
try {
  options = await readOptions();
} catch (error) {
  say(error.message);
  process.exit(2);
}

const folder = mkdtempSync(join(tmpdir(), 'lichtveld-play-'));
const removeFiles = () => rmSync(folder, { recursive: true, force: true });
const company = new Company(say, removeFiles);
process.on('exit', removeFiles);
for (const signal of ['SIGINT', 'SIGTERM', 'SIGHUP']) process.on(signal, () => company.finish(0));

const { host, address, port, executable, serveOptions, seenFromOutside } = options;
const scene = withAtlas(options.scene, options, folder);
const token = writeSecret(folder, 'token').path;
const scheme = options['tls-cert'] ? 's' : '';
// A certificate is for a name; without one the machine reaches itself by its own address.
const authority = `${scheme ? options.name[0] : urlHost(host)}:${port}`;
const client = join(root, 'web-client/dist');
const signalingArgs = ['--host', address, '--port', port, '--token-file', token, '--client', client];
signalingArgs.push('--scene', scene, ...passedOn(options));
if (!isIP(host) && !options.name?.includes(host)) signalingArgs.push('--name', host);

let joinSecret = options['join-secret-file'];
if (seenFromOutside) {
  try {
    if (!options['ice-server']) signalingArgs.push(...startTurn(company, folder, seenFromOutside));
  } catch (error) {
    say(error.message);
    process.exit(2);
  }
  if (!joinSecret) {
    joinSecret = writeSecret(folder, 'join-secret').path;
    signalingArgs.push('--join-secret-file', joinSecret);
  }
}
// Only its own word counts: whatever answers on that port may be somebody else's.
await new Promise((listening) => {
  company.start('signaling', process.execPath, [signalingMain, ...signalingArgs], (line) => {
    if (line.startsWith('signaling listens on')) listening(undefined);
  });
});

const serveArgs = ['--scene', scene, '--signaling', `ws${scheme}://${authority}/server`];
serveArgs.push('--token-file', token, '--bind', address);
if (seenFromOutside && !serveOptions.includes('--udp-port')) serveArgs.push('--udp-port', port);
if (seenFromOutside && !seenFromOutside.ours) serveArgs.push('--public-ip', seenFromOutside.address);
company.start('server', executable, ['serve', ...serveArgs, ...serveOptions]);
if (await untilServed(company, `http${scheme}://${urlHost(host)}:${port}`)) {
  const outside = seenFromOutside
    ? `http${scheme}://${options.name?.[0] ?? seenFromOutside.address}:${port}`
    : `http${scheme}://${authority}`;
  console.log(`ready ${outside}`);
  if (joinSecret) showLinks(joinSecret, outside);
}

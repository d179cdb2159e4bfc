import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { WebSocket } from 'ws';
import { startSignaling } from '../server.js';

export const token = 'a-secret-for-tests';
export const sceneBytes = Buffer.from('glTF, as far as signaling cares');

/** A folder with a small page, beside a file that must never be served. */
export function makeSite(t) {
  const root = mkdtempSync(join(tmpdir(), 'lichtveld-signaling-'));
  t.after(() => rmSync(root, { recursive: true, force: true }));
  const paths = { root, client: root, token: join(root, 'token'), scene: join(root, 'scene.glb') };
  paths.client = mkdtempSync(join(root, 'client-'));
  writeFileSync(join(paths.client, 'index.html'), '<!doctype html><title>page</title>');
  writeFileSync(paths.token, `${token}\n`);
  writeFileSync(paths.scene, sceneBytes);
  return paths;
}

/** A signaling server on a free port, ended with the test. */
export async function start(t, options = {}) {
  const site = makeSite(t);
  const server = await startSignaling({
    host: '127.0.0.1',
    port: 0,
    token,
    clientFolder: site.client,
    scene: sceneBytes,
    ...options,
  });
  t.after(() => server.close());
  return { ...server, http: `http://127.0.0.1:${server.port}`, ws: `ws://127.0.0.1:${server.port}` };
}

/** A WebSocket that keeps what it gets, so that no message is missed between two awaits. */
export class Peer {
  #messages = [];
  #wanted = [];

  constructor(url, options = {}, protocols = /** @type {string[]} */ ([])) {
    this.socket = new WebSocket(url, protocols, options);
    this.closed = new Promise((resolve) => {
      this.socket.on('close', (code, reason) => resolve({ code, reason: reason.toString() }));
    });
    this.refused = new Promise((resolve) => {
      this.socket.on('unexpected-response', (_request, response) => {
        let body = '';
        response.on('data', (chunk) => (body += chunk));
        response.on('end', () => resolve({ status: response.statusCode, body: JSON.parse(body) }));
      });
    });
    this.socket.on('error', () => {});
    this.socket.on('message', (data) => {
      const message = JSON.parse(data.toString());
      const resolve = this.#wanted.shift();
      if (resolve) resolve(message);
      else this.#messages.push(message);
    });
  }

  static server(url, { headers = {}, ...options } = {}) {
    return new Peer(`${url}/server`, { ...options, headers: { Authorization: `Bearer ${token}`, ...headers } });
  }

  static client(url, options) {
    return new Peer(`${url}/client`, options);
  }

  /** The next message; rejects when none comes, so that a silent server fails a test instead of hanging it. */
  next(timeoutMs = 3000) {
    if (this.#messages.length > 0) return Promise.resolve(this.#messages.shift());
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => reject(new Error(`no message within ${timeoutMs} ms`)), timeoutMs);
      this.#wanted.push((message) => {
        clearTimeout(timer);
        resolve(message);
      });
    });
  }

  send(value) {
    this.socket.send(typeof value === 'string' || Buffer.isBuffer(value) ? value : JSON.stringify(value));
  }
}

/** A render server and clients that have all been greeted. */
export async function populate(signaling, clientCount) {
  const server = Peer.server(signaling.ws);
  const serverId = (await server.next()).id;
  const clients = [];
  for (let i = 0; i < clientCount; ++i) {
    const peer = Peer.client(signaling.ws);
    const { id } = await peer.next();
    clients.push({ peer, id });
  }
  return { server, serverId, clients };
}

/** The value of one metric, e.g. `name{label="x"}`; 0 where it has not been counted. */
export async function metric(signaling, name) {
  const text = await (await fetch(`${signaling.http}/metrics`)).text();
  const line = text.split('\n').find((candidate) => candidate.startsWith(`lichtveld_signaling_${name} `));
  return line === undefined ? 0 : Number(line.split(' ')[1]);
}

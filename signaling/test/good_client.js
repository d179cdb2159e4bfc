import { get } from 'node:http';
import { setTimeout as sleep } from 'node:timers/promises';
import { Peer } from './harness.js';

/** A connection of its own, as a new visitor has. */
const load = (url, path, localAddress) =>
  new Promise((resolve, reject) => {
    const request = get(`${url}${path}`, { agent: false, localAddress, timeout: 10_000 }, (response) => {
      let length = 0;
      response.on('data', (chunk) => (length += chunk.length));
      response.on('end', () =>
        response.statusCode === 200 && length === Number(response.headers['content-length'])
          ? resolve(undefined)
          : reject(new Error(`${path}: ${response.statusCode}, ${length} bytes`)),
      );
      response.on('error', reject);
    });
    request.on('timeout', () => request.destroy(new Error(`${path}: no answer`)));
    request.on('error', reject);
  });

/**
 * Somebody who plays while others come and load the page, all of them from one address: what takes how long, and what
 * fails. `server` and `player` are peers who have been greeted.
 */
export class GoodClient {
  #signaling;
  #server;
  #player;
  #address;

  constructor(signaling, { server, player, address }) {
    this.#signaling = signaling;
    this.#server = server;
    this.#player = player;
    this.#address = address;
  }

  async #page() {
    await load(this.#signaling.http, '/', this.#address);
    await load(this.#signaling.http, '/assets/app.js', this.#address);
  }

  async #join() {
    const peer = Peer.client(this.#signaling.ws, { localAddress: this.#address });
    try {
      const closed = peer.closed.then(({ code, reason }) => {
        throw new Error(`closed with ${code} ${reason}`);
      });
      const refused = peer.refused.then(({ status }) => {
        throw new Error(`refused with ${status}`);
      });
      const { type } = await Promise.race([peer.next(10_000), closed, refused]);
      if (type !== 'welcome') throw new Error(`${type} instead of welcome`);
    } finally {
      peer.socket.terminate();
    }
  }

  async #relay() {
    const { peer, id, serverId } = this.#player;
    peer.send({ id: serverId, type: 'candidate', candidate: 'candidate:1', mid: '0' });
    for (
      let message = await this.#server.next();
      message.type !== 'candidate';
      message = await this.#server.next()
    );
    this.#server.send({ id, type: 'role', cube: 1, players: 1, watchers: 0 });
    for (let message = await peer.next(); message.type !== 'role'; message = await peer.next());
  }

  /** @returns median milliseconds of each step, and the errors */
  async goesOn(milliseconds) {
    const steps = { page: () => this.#page(), join: () => this.#join(), relay: () => this.#relay() };
    const times = { page: [], join: [], relay: [] };
    const errors = [];
    const end = performance.now() + milliseconds;
    while (performance.now() < end) {
      for (const [name, step] of Object.entries(steps)) {
        const begin = performance.now();
        await step().then(
          () => times[name].push(performance.now() - begin),
          (error) => errors.push(`${name}: ${error.message}`),
        );
      }
      await sleep(100);
    }
    const median = (list) => list.sort((a, b) => a - b)[Math.floor(list.length / 2)];
    return { page: median(times.page), join: median(times.join), relay: median(times.relay), errors };
  }
}

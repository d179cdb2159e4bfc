/**
 * Who is in the room and who may talk to whom. Pure: every call answers with the messages to deliver.
 *
 * @typedef {{to: string, message: object}} Delivery
 */
export class Room {
  /** @type {{id: string, sceneSha256?: string} | undefined} */
  #server;
  /** @type {Set<string>} */
  #clients = new Set();

  get hasServer() {
    return this.#server !== undefined;
  }

  get clientCount() {
    return this.#clients.size;
  }

  /**
   * The render server comes; everybody who waited is told. Only one may be there: ask `hasServer` first.
   * @param {string} id
   * @param {string} [sceneSha256]  of the scene file that it lights, as 64 hex digits
   * @returns {Delivery[]}
   */
  serverJoins(id, sceneSha256) {
    this.#server = { id, sceneSha256 };
    return [
      { to: id, message: { type: 'welcome', id } },
      ...[...this.#clients].map((client) => this.#welcome(client)),
    ];
  }

  /**
   * @param {string} id
   * @returns {Delivery[]}
   */
  clientJoins(id) {
    this.#clients.add(id);
    const welcome = this.#welcome(id);
    return this.#server ? [welcome] : [welcome, { to: id, message: { type: 'waiting' } }];
  }

  /**
   * @param {string} id  of the render server or of a client; one that is not there is no error
   * @returns {Delivery[]}
   */
  leaves(id) {
    if (this.#server?.id === id) {
      this.#server = undefined;
      return [...this.#clients].map((to) => ({ to, message: { type: 'waiting' } }));
    }
    if (!this.#clients.delete(id) || !this.#server) return [];
    return [{ to: this.#server.id, message: { id, type: 'gone' } }];
  }

  /**
   * Clients may talk to the server only, the server to every client. The receiver sees the sender's id.
   * @param {string} from
   * @param {import('./messages.js').Message} message  `id` names the receiver
   * @returns {Delivery | {refused: string}}
   */
  relay(from, message) {
    const to = message.id;
    const known = this.#server?.id === to || this.#clients.has(to);
    if (!known) return { refused: 'no_such_peer' };
    const allowed = this.#server?.id === from ? this.#clients.has(to) : to === this.#server?.id;
    return allowed ? { to, message: { ...message, id: from } } : { refused: 'forbidden_route' };
  }

  /** @param {string} to */
  #welcome(to) {
    const message = { type: 'welcome', id: to };
    if (!this.#server) return { to, message };
    const { id: server, sceneSha256: sha256 } = this.#server;
    const scene = { url: '/scene.glb', ...(sha256 && { sha256 }) };
    return { to, message: { ...message, server, scene } };
  }
}

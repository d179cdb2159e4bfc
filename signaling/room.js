/**
 * Who is in the room and who may talk to whom. Pure: every call answers with the messages to deliver.
 *
 * @typedef {{to: string, message: object}} Delivery
 */
export class Room {
  /** @type {{id: string, sceneSha256?: string} | undefined} */
  #server;
  /** @type {Map<string, import('./join_tokens.js').Ticket>} */
  #clients = new Map();
  #iceServersFor;

  /** @param {(id: string) => object[]} [iceServersFor]  what this peer is given to find a way with */
  constructor(iceServersFor = () => []) {
    this.#iceServersFor = iceServersFor;
  }

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
    return [...this.greetServer(), ...[...this.#clients.keys()].map((client) => this.#welcome(client))];
  }

  /**
   * The render server's greeting; once more before the credentials in it expire.
   * @returns {Delivery[]}
   */
  greetServer() {
    if (!this.#server) return [];
    const { id } = this.#server;
    return [{ to: id, message: this.#withIceServers({ type: 'welcome', id }) }];
  }

  /**
   * @param {string} id
   * @param {import('./join_tokens.js').Ticket} [ticket]  what its link allows it
   * @returns {Delivery[]}
   */
  clientJoins(id, ticket = {}) {
    this.#clients.set(id, ticket);
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
      return [...this.#clients.keys()].map((to) => ({ to, message: { type: 'waiting' } }));
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
    if (!allowed) return { refused: 'forbidden_route' };
    // Whether somebody may play, and what he is called, is the token's word and not his own.
    const ticket = message.type === 'offer' ? this.#clients.get(from) : {};
    return { to, message: { ...message, ...ticket, id: from } };
  }

  /** @param {string} to */
  #welcome(to) {
    const message = this.#withIceServers({ type: 'welcome', id: to, ...this.#clients.get(to) });
    if (!this.#server) return { to, message };
    const { id: server, sceneSha256: sha256 } = this.#server;
    const scene = { url: '/scene.glb', ...(sha256 && { sha256 }) };
    return { to, message: { ...message, server, scene } };
  }

  #withIceServers(message) {
    const iceServers = this.#iceServersFor(message.id);
    return iceServers.length > 0 ? { ...message, iceServers } : message;
  }
}

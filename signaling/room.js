/**
 * Who is in the room and who may talk to whom. Pure: every call answers with the messages to deliver.
 *
 * @typedef {{to: string, message: {type: string} & Record<string, any>}} Delivery
 * @typedef {import('./join_tokens.js').Pass} Pass
 */
export class Room {
  /** @type {{id: string, sceneSha256?: string | undefined} | undefined} */
  #server;
  /** @type {Map<string, {seat?: 'watcher', name?: string}>} */
  #clients = new Map();
  #iceServersFor;

  /** @param {(id: string) => import('./ice.js').IceServer[] | undefined} [iceServersFor]  what a peer is told of */
  constructor(iceServersFor = () => undefined) {
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
    return [...this.renewIceServers(), ...[...this.#clients.keys()].map((client) => this.#welcome(client))];
  }

  /**
   * The render server stays longer than what it is told of STUN and TURN servers is good for. Clients need it once.
   * @returns {Delivery[]}
   */
  renewIceServers() {
    return this.#server ? [{ to: this.#server.id, message: this.#greeting(this.#server.id) }] : [];
  }

  /**
   * @param {string} id
   * @param {Pass} [pass]  what its token says, where tokens are wanted
   * @returns {Delivery[]}
   */
  clientJoins(id, pass) {
    this.#clients.set(id, {
      ...(pass?.role === 'watcher' && { seat: 'watcher' }),
      ...(pass?.name !== undefined && { name: pass.name }),
    });
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
   * Clients may talk to the server only, the server to every client. The receiver sees the sender's id, and in an offer
   * the seat and name of the client's token: never its own word for them, which has not come through the parser.
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
    return {
      to,
      message: { ...message, id: from, ...(message.type === 'offer' && this.#clients.get(from)) },
    };
  }

  /** @param {string} to */
  #welcome(to) {
    const message = { ...this.#greeting(to), ...this.#clients.get(to) };
    if (!this.#server) return { to, message };
    const { id: server, sceneSha256: sha256 } = this.#server;
    const scene = { url: '/scene.glb', ...(sha256 && { sha256 }) };
    return { to, message: { ...message, server, scene } };
  }

  /** @param {string} id */
  #greeting(id) {
    const iceServers = this.#iceServersFor(id);
    return { type: 'welcome', id, ...(iceServers && { iceServers }) };
  }
}

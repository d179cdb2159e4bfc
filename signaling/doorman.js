import { Server as TlsServer } from 'node:tls';
import { sendJson } from './answers.js';
import { SlowRefusals } from './slow_refusals.js';

/**
 * Holds the HTTP server to the limits by address: lets connections in, makes room, ends those that misbehave. All of it
 * happens before anything is verified, made or kept for a peer.
 *
 * @typedef {import('node:net').Socket} Socket
 * @typedef {import('node:http').IncomingMessage} Request
 * @typedef {{address: string, socket: Socket}} Answer  to somebody, on a connection that may be a proxy's
 * @typedef {{socket: Socket, address: string, answers: Set<Answer>}} Guest
 *   a connection: `socket` is the TLS socket once there is one, `answers` those that are not complete
 */
export class Doorman {
  #gate;
  #addresses;
  #limits;
  #metrics;
  #refusals;
  #slowRefusals;
  /** By TCP and by TLS socket. @type {WeakMap<object, Guest>} */
  #guests = new WeakMap();
  /** By what a TLS socket has in common with the TCP socket below it. @type {Map<string, Guest>} */
  #handshaking = new Map();

  /**
   * @param {{gate: import('./address_gate.js').AddressGate<Guest, Answer>,
   *          addresses: import('./addresses.js').Addresses, limits: import('./limits.js').Limits,
   *          metrics: import('./metrics.js').Metrics, refusals: import('./log.js').Refusals}} options
   */
  constructor({ gate, addresses, limits, metrics, refusals }) {
    this.#gate = gate;
    this.#addresses = addresses;
    this.#limits = limits;
    this.#metrics = metrics;
    this.#refusals = refusals;
    this.#slowRefusals = new SlowRefusals(limits);
  }

  /** @param {import('node:http').Server} server  HTTP or HTTPS, before it listens */
  guard(server) {
    // Ours goes first and alone: a connection that is refused must cost neither a TLS handshake nor a parser.
    const serve = server.listeners('connection');
    server.removeAllListeners('connection');
    server.on('connection', (socket) => {
      if (this.#admits(socket, server instanceof TlsServer))
        for (const listener of serve) listener.call(server, socket);
    });
    server.prependListener('secureConnection', (socket) => {
      const guest = this.#handshaking.get(endsOf(socket));
      if (!guest) return socket.destroy();
      guest.socket = socket;
      this.#guests.set(socket, guest);
    });
    // Node tells the client with the last answer, and answers for ever after with 503.
    server.on('dropRequest', (_request, socket) => socket.destroy());
    server.on('clientError', (error, socket) => this.#breaks(error, socket));
    server.on('timeout', (socket) => {
      if (this.#guests.get(socket)?.answers.size) this.#end(socket, 'unread', 'an answer was not read');
      else socket.destroy(); // kept alive for a request that did not come
    });
  }

  /** Ends what the server does not know of yet. */
  close() {
    for (const { socket } of this.#handshaking.values()) socket.destroy();
    this.#slowRefusals.close();
  }

  /**
   * @param {Request} request
   * @param {import('node:http').ServerResponse} response  answered here when the request is refused
   * @returns {boolean}
   */
  admitsRequest(request, response) {
    const { socket } = request;
    const guest = this.#guests.get(socket);
    if (!guest) return false;
    if (guest.answers.size >= this.#limits.maxPipelinedRequests) {
      this.#gate.abuses(guest.address, performance.now());
      closesWithoutStacks(socket);
      this.#end(socket, 'pipelined', 'more requests came than wait for answers');
      return false;
    }
    const address = this.#addresses.ofRequest(request);
    const answer = { address, socket };
    guest.answers.add(answer);
    response.once('close', () => this.#answered(guest, answer));
    const oldest = this.#gate.answers(address, answer, performance.now());
    if (oldest) this.#end(oldest.socket, 'address_answers', 'the oldest answer made room for another');
    if (this.#gate.mayRequest(address, performance.now())) return true;
    this.#refusals.note(this.#metrics.refusedRequests, 'request_rate', address, 'too many requests');
    const error = 'too many requests from your address: try again in some seconds';
    sendJson(response, 429, { error }, { Connection: 'close', 'Retry-After': 5 });
    return false;
  }

  /**
   * A WebSocket has been made of a connection: it makes no room for others any more.
   * @param {object} socket
   */
  becameWebSocket(socket) {
    const guest = this.#guests.get(socket);
    if (guest) this.#gate.becomesWebSocket(guest.address, guest);
  }

  /** @type {(socket: Socket, isTls: boolean) => boolean} */
  #admits(socket, isTls) {
    const address = this.#addresses.ofSocket(socket);
    const guest = { socket, address, answers: new Set() };
    const place = this.#gate.connects(address, guest, performance.now(), this.#addresses.isProxy(socket));
    if ('refused' in place) {
      this.#refusals.note(this.#metrics.refusedConnections, place.refused, address, 'too many connections');
      this.#slowRefusals.refuse(socket);
      return false;
    }
    if (place.evicted)
      this.#end(place.evicted.socket, place.reason ?? '', 'the oldest connection made room for another');
    const ends = endsOf(socket);
    this.#guests.set(socket, guest);
    if (isTls) this.#handshaking.set(ends, guest);
    socket.once('close', () => {
      if (this.#handshaking.get(ends) === guest) this.#handshaking.delete(ends);
      this.#gate.disconnects(address, guest);
      // Answers that wait behind another are not told of their connection's end.
      for (const answer of guest.answers) this.#answered(guest, answer);
    });
    return true;
  }

  /** @type {(guest: Guest, answer: Answer) => void} */
  #answered(guest, answer) {
    guest.answers.delete(answer);
    this.#gate.answered(answer.address, answer);
  }

  /**
   * What came is no HTTP or TLS, has too large headers, or did not come in time. The error holds what was sent, which may
   * be a secret: it is never logged.
   * @type {(error: Error & {code?: string}, socket: import('node:stream').Duplex) => void}
   */
  #breaks({ code = '' }, socket) {
    const guest = this.#guests.get(socket);
    const broken = brokenBy[code] ?? (code.startsWith('HPE_') ? brokenBy.HPE : undefined);
    // An answer that is under way could only be garbled.
    if (broken?.status && socket.writable && guest?.answers.size === 0)
      socket.write(`HTTP/1.1 ${broken.status}\r\nConnection: close\r\nContent-Length: 0\r\n\r\n`);
    if (broken?.reason) this.#end(socket, broken.reason, broken.text);
    else if (/^ERR_(SSL|TLS)/.test(code)) this.#end(socket, 'tls', 'a TLS handshake failed');
    else socket.destroy();
  }

  /** @type {(socket: import('node:stream').Duplex, reason: string, text: string) => void} */
  #end(socket, reason, text) {
    const guest = this.#guests.get(socket) ?? this.#handshaking.get(endsOf(socket));
    const address = guest?.address ?? 'unknown';
    this.#refusals.note(this.#metrics.droppedConnections, reason, address, text);
    socket.destroy();
  }
}

/**
 * Node makes an error for each request that a connection leaves unanswered. The stacks of 1,700 of them would be most of
 * what such a connection costs.
 * @param {Socket} socket
 */
function closesWithoutStacks(socket) {
  const { stackTraceLimit } = Error;
  socket.prependOnceListener('close', () => (Error.stackTraceLimit = 0));
  socket.once('close', () => (Error.stackTraceLimit = stackTraceLimit));
}

const brokenBy = {
  ERR_HTTP_REQUEST_TIMEOUT: {
    status: '408 Request Timeout',
    reason: 'headers_timeout',
    text: 'a request did not come in time',
  },
  HPE_HEADER_OVERFLOW: {
    status: '431 Request Header Fields Too Large',
    reason: 'headers_size',
    text: 'too large headers',
  },
  HPE: { status: '400 Bad Request', reason: 'no_http', text: 'what came is no HTTP' },
  /** Who leaves in the middle of a request does nothing wrong. */
  HPE_INVALID_EOF_STATE: {},
};

/** @type {(socket: any) => string} */
const endsOf = ({ remoteAddress, remotePort, localAddress }) =>
  `${remoteAddress} ${remotePort} ${localAddress}`;

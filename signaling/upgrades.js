import { WebSocketServer } from 'ws';
import { hasGoodOrigin, hasToken, sceneHash } from './admission.js';
import { refuseUpgrade } from './answers.js';
import { protocolName } from './join_tokens.js';
import { pathOf } from './requests.js';

/**
 * Who may have a WebSocket: the render server at /server, clients at /client.
 *
 * @typedef {import('node:http').IncomingMessage} Request
 *
 * @param {{room: import('./room.js').Room, metrics: import('./metrics.js').Metrics,
 *          refusals: import('./log.js').Refusals, gate: import('./address_gate.js').AddressGate<any, any>,
 *          doorman: import('./doorman.js').Doorman, addresses: import('./addresses.js').Addresses,
 *          hosts: import('./hosts.js').Hosts, joinTokens?: import('./join_tokens.js').JoinTokens,
 *          relay: import('./relay.js').Relay, limits: import('./limits.js').Limits, token: string,
 *          allowedOrigins: string[]}} options
 * @returns {(request: Request, socket: import('node:stream').Duplex, head: Buffer) => Promise<void>}
 */
export function createUpgrades(options) {
  const { room, metrics, refusals, gate, doorman, addresses, hosts, joinTokens, relay, limits } = options;
  const webSockets = new WebSocketServer({
    noServer: true,
    clientTracking: false,
    maxPayload: limits.maxMessageBytes,
    perMessageDeflate: false, // small messages: not worth a decompressor that strangers can feed
    maxPendingAutoPongs: 0, // pings count as messages do (connection.js): ws would end it without a word
    // The other one that a client asks for is its token.
    handleProtocols: (protocols) => protocols.has(protocolName) && protocolName,
  });

  /** @type {(request: Request, socket: import('node:stream').Duplex, status: number, reason: string, error: string) => void} */
  const refuse = (request, socket, status, reason, error) => {
    refusals.note(metrics.refusedConnections, reason, addresses.ofRequest(request), error);
    refuseUpgrade(socket, status, error);
  };
  webSockets.on('wsClientError', (error, socket, request) =>
    refuse(request, socket, 400, 'handshake', `no WebSocket handshake: ${error.message}`),
  );

  const upgradeServer = (request, socket, head) => {
    if (!hasToken(request, options.token))
      return refuse(request, socket, 401, 'token', 'wrong or missing token');
    if (room.hasServer)
      return refuse(request, socket, 409, 'second_server', 'a render server is already connected');
    webSockets.handleUpgrade(request, socket, head, (ws) => {
      doorman.becameWebSocket(socket);
      relay.acceptServer(ws, sceneHash(request));
    });
  };

  /** Why a client cannot be let in, in a way that its page can read. */
  const obstacle = (address, refused) => {
    if (refused) return { code: 4401, reason: 'join_token', text: refused };
    if (room.clientCount >= limits.maxClients)
      return { code: 1013, reason: 'room_full', text: 'the room is full' };
    if (!gate.mayJoin(address, performance.now()))
      return { code: 1013, reason: 'address_full', text: 'too many connections from your address' };
    return undefined;
  };

  const upgradeClient = async (request, socket, head) => {
    const misnamed = hosts.refusal(request.headers.host);
    if (misnamed) return refuse(request, socket, 421, 'host', misnamed);
    if (!hasGoodOrigin(request, options.allowedOrigins)) {
      const origin = String(request.headers.origin).slice(0, 100);
      return refuse(request, socket, 403, 'origin', `pages of ${origin} may not join`);
    }
    const { refused, pass } = (await joinTokens?.ofRequest(request)) ?? {};
    const address = addresses.ofRequest(request);
    webSockets.handleUpgrade(request, socket, head, (ws) => {
      const obstructed = obstacle(address, refused);
      if (!obstructed) {
        doorman.becameWebSocket(socket);
        return relay.acceptClient(ws, socket, address, pass);
      }
      // A browser cannot read the answer to a refused upgrade, so it is accepted and closed with the reason.
      refusals.note(metrics.refusedConnections, obstructed.reason, address, obstructed.text);
      ws.on('error', () => {});
      ws.close(obstructed.code, obstructed.text);
      setTimeout(() => ws.terminate(), limits.closeTimeoutMs).unref();
    });
  };

  return async (request, socket, head) => {
    socket.on('error', () => socket.destroy());
    const path = pathOf(request);
    const isServer = path === '/server' && hasToken(request, options.token);
    // The render server comes back at once, whatever somebody else at its address (this machine's, say) is doing.
    if (!isServer && !gate.mayUpgrade(addresses.ofRequest(request), performance.now()))
      return refuse(request, socket, 429, 'upgrade_rate', 'too many connections from your address');
    if (path === '/server') return upgradeServer(request, socket, head);
    if (path === '/client') return upgradeClient(request, socket, head);
    return refuse(request, socket, 404, 'path', 'WebSockets are at /server and /client');
  };
}

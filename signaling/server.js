import { randomUUID } from 'node:crypto';
import { WebSocketServer } from 'ws';
import { createAddressFinder } from './addresses.js';
import { hasGoodOrigin, hasToken, refuseUpgrade, sceneHash } from './admission.js';
import { Connection } from './connection.js';
import { Gate } from './gate.js';
import { createHostCheck } from './hosts.js';
import { connectionKey, createGuardedServer, createHandler, pathOf } from './http.js';
import { createIceServers } from './ice.js';
import { JoinTokens, subProtocol, tokenOf } from './join_tokens.js';
import { defaultLimits } from './limits.js';
import { parseMessage } from './messages.js';
import { createMetrics } from './metrics.js';
import { createRefusals } from './refusals.js';
import { Room } from './room.js';
import { readCertificate, watchCertificate } from './tls.js';

/** Codes by which a browser, which cannot read the answer to a refused upgrade, learns why it was refused. */
const closeCodes = { tryAgainLater: 1013, notAdmitted: 4401 };

/**
 * Starts the signaling server: /server for the render server, /client for browsers, the web client's files,
 * /scene.glb, /healthz and /metrics.
 *
 * @typedef {{host: string, port: number, token: string, clientFolder: string, scene: Buffer,
 *            names?: string[], allowedOrigins?: string[], proxies?: string[], iceUrls?: string[], turnSecret?: string,
 *            joinSecret?: string, tls?: {cert: string, key: string},
 *            limits?: Partial<import('./limits.js').Limits>, log?: (line: string) => void}} Options
 *   port 0 takes a free one; names and proxies as in hosts.js and addresses.js; without joinSecret everybody may join
 * @param {Options} options
 * @returns {Promise<{port: number, close: () => Promise<void>}>} rejects with the system's error (EADDRINUSE, ...)
 */
export async function startSignaling({ log = () => {}, ...options }) {
  const limits = { ...defaultLimits, ...options.limits };
  const addresses = createAddressFinder(options.proxies ?? []);
  const iceServers = {
    urls: options.iceUrls ?? [],
    turnSecret: options.turnSecret,
    lifetimeMs: limits.turnLifetimeMs,
  };
  const room = new Room(createIceServers(iceServers));
  const metrics = createMetrics(room);
  const refuse = createRefusals(metrics, log);
  const gate = new Gate(limits);
  const tokens = options.joinSecret === undefined ? undefined : new JoinTokens(options.joinSecret);
  const hostIsOurs = createHostCheck(options.names ?? []);
  /** @type {Map<string, Connection>} */
  const connections = new Map();

  const deliver = (deliveries) => {
    for (const { to, message } of deliveries) connections.get(to)?.send(message);
  };

  const accept = (socket, role, { onClose = () => {}, ...join }) => {
    const id = randomUUID();
    const connection = new Connection(socket, {
      id,
      role,
      limits,
      metrics,
      onMessage(text) {
        const parsed = parseMessage(text, role, limits);
        if ('refused' in parsed) return connection.refuse(parsed.refused);
        if ('work' in parsed) return metrics.showWork(parsed.work);
        const relayed = room.relay(id, parsed.message);
        if ('refused' in relayed) return connection.refuse(relayed.refused);
        metrics.relayedMessages.inc({ type: parsed.message.type });
        metrics.relayedBytes.inc(Buffer.byteLength(text));
        deliver([relayed]);
      },
      onClose() {
        connections.delete(id);
        if (role === 'server') metrics.showWork();
        onClose();
        deliver(room.leaves(id));
        log(`${role} ${id} left; ${room.clientCount} clients`);
      },
    });
    connections.set(id, connection);
    metrics.connections.inc({ role });
    deliver(role === 'server' ? room.serverJoins(id, join.sceneSha256) : room.clientJoins(id, join.ticket));
    const name = join.ticket?.name ? ` (${join.ticket.name})` : '';
    log(`${role} ${id}${name} joined; ${room.clientCount} clients`);
  };

  const webSockets = new WebSocketServer({
    noServer: true,
    clientTracking: false,
    maxPayload: limits.maxMessageBytes,
    perMessageDeflate: false, // small messages: not worth a decompressor that strangers can feed
    handleProtocols: (protocols) => (protocols.has(subProtocol) ? subProtocol : false),
  });

  const decline = (request, socket, status, reason, error) => {
    refuse(reason, addresses.visitor(request), error);
    refuseUpgrade(socket, status, error);
  };

  const upgradeServer = (request, socket, head) => {
    if (!hasToken(request, options.token))
      return decline(request, socket, 401, 'token', 'wrong or missing token');
    if (room.hasServer)
      return decline(request, socket, 409, 'second_server', 'a render server is already connected');
    const sceneSha256 = sceneHash(request);
    webSockets.handleUpgrade(request, socket, head, (ws) => accept(ws, 'server', { sceneSha256 }));
  };

  // A browser cannot read the answer to a refused upgrade, so it is accepted and closed with the reason.
  const turnAway = (request, socket, head, { reason, code, text }) => {
    refuse(reason, addresses.visitor(request), text);
    webSockets.handleUpgrade(request, socket, head, (ws) => {
      ws.on('error', () => {});
      ws.close(code, text);
      setTimeout(() => ws.terminate(), limits.closeTimeoutMs).unref();
    });
  };

  const upgradeClient = async (request, socket, head) => {
    if (!hostIsOurs(request.headers.host))
      return decline(request, socket, 421, 'host', 'this page is not served by that name (see --name)');
    if (!hasGoodOrigin(request, options.allowedOrigins ?? [])) {
      const origin = String(request.headers.origin).slice(0, 100);
      return decline(request, socket, 403, 'origin', `pages of ${origin} may not join`);
    }
    const admitted = tokens ? await tokens.verify(tokenOf(request)) : { ticket: {} };
    if (socket.destroyed) return;
    if ('refused' in admitted) {
      const { refused: reason, text } = admitted;
      return turnAway(request, socket, head, { reason, code: closeCodes.notAdmitted, text });
    }
    const visitor = addresses.visitor(request);
    const full =
      room.clientCount >= limits.maxClients
        ? { reason: 'room_full', text: 'the room is full' }
        : gate.enters(visitor, performance.now())
          ? undefined
          : { reason: 'address_full', text: 'too many connections from your address' };
    if (full) return turnAway(request, socket, head, { ...full, code: closeCodes.tryAgainLater });
    const onClose = () => gate.leaves(visitor);
    let accepted = false;
    webSockets.handleUpgrade(request, socket, head, (ws) => {
      accepted = true;
      accept(ws, 'client', { ticket: admitted.ticket, onClose });
    });
    // Refused by the library itself, which has answered: no place is held.
    if (!accepted) onClose();
  };

  const handler = createHandler({ room, metrics, tokens, ...options });
  const certificate = options.tls && readCertificate(options.tls);
  const http = createGuardedServer({ limits, gate, addresses, refuse, hostIsOurs, certificate }, handler);
  http.on('upgrade', (request, socket, head) => {
    socket.on('error', () => socket.destroy());
    socket.setTimeout(0); // from here on pings tell whether somebody is there
    const visitor = addresses.visitor(request);
    if (!gate.joins(visitor, performance.now()))
      return decline(request, socket, 429, 'joins', 'too many attempts to join');
    gate.upgrades(addresses.visitorOf(socket.remoteAddress), connectionKey(socket));
    const path = pathOf(request);
    if (path === '/server') upgradeServer(request, socket, head);
    else if (path === '/client') upgradeClient(request, socket, head);
    else decline(request, socket, 404, 'path', 'WebSockets are at /server and /client');
  });

  await new Promise((resolve, reject) => {
    http.once('error', reject);
    http.listen(options.port, options.host, () => resolve(undefined));
  });
  const stopWatching = options.tls
    ? watchCertificate(
        options.tls,
        /** @type {import('node:https').Server} */ (http),
        log,
        limits.certificateLookMs,
      )
    : () => {};
  const timers = [
    setInterval(() => {
      for (const connection of connections.values()) connection.heartbeat();
    }, limits.pingIntervalMs),
    setInterval(() => gate.forget(performance.now()), limits.visitorMemoryMs),
    setInterval(() => deliver(room.greetServer()), limits.turnLifetimeMs / 2),
  ];

  return {
    port: /** @type {import('node:net').AddressInfo} */ (http.address()).port,
    async close() {
      timers.forEach(clearInterval);
      stopWatching();
      const closed = new Promise((resolve) => http.close(resolve));
      // All in one go, so that nobody hears of the others' leaving: the render server would end the sessions of clients
      // that it took for gone, and those go on without us.
      for (const connection of connections.values())
        connection.close(1001, 'the signaling server is shutting down');
      setTimeout(() => http.closeAllConnections(), limits.closeTimeoutMs).unref();
      http.closeIdleConnections();
      await closed;
    },
  };
}

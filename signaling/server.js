import { randomUUID } from 'node:crypto';
import { createServer } from 'node:http';
import { WebSocketServer } from 'ws';
import { hasGoodOrigin, hasToken, refuseUpgrade, sceneHash } from './admission.js';
import { Connection } from './connection.js';
import { defaultLimits } from './limits.js';
import { parseMessage } from './messages.js';
import { createMetrics } from './metrics.js';
import { Room } from './room.js';
import { serveClient, serveScene } from './static.js';

/**
 * Starts the signaling server: /server for the render server, /client for browsers, the web client's files,
 * /scene.glb, /healthz and /metrics.
 *
 * @param {{host: string, port: number, token: string, clientFolder: string, scene: Buffer,
 *          allowedOrigins?: string[], limits?: Partial<import('./limits.js').Limits>,
 *          log?: (line: string) => void}} options  port 0 takes a free one
 * @returns {Promise<{port: number, close: () => Promise<void>}>} rejects with the system's error (EADDRINUSE, ...)
 */
export async function startSignaling({ log = () => {}, allowedOrigins = [], ...options }) {
  const limits = { ...defaultLimits, ...options.limits };
  const room = new Room();
  const metrics = createMetrics(room);
  /** @type {Map<string, Connection>} */
  const connections = new Map();
  /** @type {Map<string, number>} */
  const clientsOfAddress = new Map();

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
    deliver(role === 'server' ? room.serverJoins(id, join.sceneSha256) : room.clientJoins(id));
    log(`${role} ${id} joined; ${room.clientCount} clients`);
  };

  const webSockets = new WebSocketServer({
    noServer: true,
    clientTracking: false,
    maxPayload: limits.maxMessageBytes,
    perMessageDeflate: false, // small messages: not worth a decompressor that strangers can feed
  });

  const refuse = (socket, status, reason, error) => {
    metrics.refusedConnections.inc({ reason });
    log(`refused a connection: ${error}`);
    refuseUpgrade(socket, status, error);
  };

  const upgradeServer = (request, socket, head) => {
    if (!hasToken(request, options.token)) return refuse(socket, 401, 'token', 'wrong or missing token');
    if (room.hasServer) return refuse(socket, 409, 'second_server', 'a render server is already connected');
    const sceneSha256 = sceneHash(request);
    webSockets.handleUpgrade(request, socket, head, (ws) => accept(ws, 'server', { sceneSha256 }));
  };

  const upgradeClient = (request, socket, head) => {
    if (!hasGoodOrigin(request, allowedOrigins))
      return refuse(
        socket,
        403,
        'origin',
        `pages of ${String(request.headers.origin).slice(0, 100)} may not join`,
      );
    const address = request.socket.remoteAddress ?? '';
    const sameAddress = clientsOfAddress.get(address) ?? 0;
    const full =
      room.clientCount >= limits.maxClients
        ? { reason: 'room_full', text: 'the room is full' }
        : sameAddress >= limits.maxClientsPerAddress
          ? { reason: 'address_full', text: 'too many connections from your address' }
          : undefined;
    webSockets.handleUpgrade(request, socket, head, (ws) => {
      // A browser cannot read the answer to a refused upgrade, so it is accepted and closed with the reason.
      if (full) {
        metrics.refusedConnections.inc({ reason: full.reason });
        ws.on('error', () => {});
        ws.close(1013, full.text);
        setTimeout(() => ws.terminate(), limits.closeTimeoutMs).unref();
        return;
      }
      clientsOfAddress.set(address, sameAddress + 1);
      const onClose = () => {
        const left = (clientsOfAddress.get(address) ?? 1) - 1;
        if (left > 0) clientsOfAddress.set(address, left);
        else clientsOfAddress.delete(address);
      };
      accept(ws, 'client', { onClose });
    });
  };

  const http = createServer(createHandler({ room, metrics, ...options }));
  http.headersTimeout = limits.headersTimeoutMs;
  http.maxConnections = limits.maxTcpConnections;
  http.on('upgrade', (request, socket, head) => {
    socket.on('error', () => socket.destroy());
    const path = pathOf(request);
    if (path === '/server') upgradeServer(request, socket, head);
    else if (path === '/client') upgradeClient(request, socket, head);
    else refuse(socket, 404, 'path', 'WebSockets are at /server and /client');
  });

  await new Promise((resolve, reject) => {
    http.once('error', reject);
    http.listen(options.port, options.host, () => resolve(undefined));
  });
  const heartbeat = setInterval(() => {
    for (const connection of connections.values()) connection.heartbeat();
  }, limits.pingIntervalMs);

  return {
    port: /** @type {import('node:net').AddressInfo} */ (http.address()).port,
    async close() {
      clearInterval(heartbeat);
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

/** @type {(request: import('node:http').IncomingMessage) => string} */
const pathOf = (request) => (request.url ?? '/').split('?', 1)[0];

/** The plain HTTP side. */
function createHandler({ room, metrics, clientFolder, scene }) {
  const client = serveClient(clientFolder);
  const sceneFile = serveScene(scene);
  const plain = { 'Cache-Control': 'no-store', 'X-Content-Type-Options': 'nosniff' };
  const sendJson = (response, status, value) =>
    response.writeHead(status, { ...plain, 'Content-Type': 'application/json' }).end(JSON.stringify(value));

  return async (request, response) => {
    if (request.method !== 'GET' && request.method !== 'HEAD')
      return sendJson(response.setHeader('Allow', 'GET, HEAD'), 405, { error: 'only GET and HEAD' });
    switch (pathOf(request)) {
      case '/healthz':
        return sendJson(response, 200, { status: 'ok', server: room.hasServer, clients: room.clientCount });
      case '/metrics':
        response.writeHead(200, { ...plain, 'Content-Type': metrics.registry.contentType });
        return response.end(await metrics.registry.metrics());
      case '/scene.glb':
        return sceneFile(request, response);
      default:
        client(request, response, () => sendJson(response, 404, { error: 'no such file' }));
    }
  };
}

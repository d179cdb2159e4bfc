import { createServer } from 'node:http';
import { createServer as createSecureServer } from 'node:https';
import { readClient, sceneFile, sendFile } from './files.js';
import { tokenOf } from './join_tokens.js';

/** @type {(request: import('node:http').IncomingMessage) => string} */
export const pathOf = (request) => (request.url ?? '/').split('?', 1)[0];

const plain = { 'Cache-Control': 'no-store', 'X-Content-Type-Options': 'nosniff' };

/** @type {(response: import('node:http').ServerResponse, status: number, value: object, headers?: object) => void} */
const sendJson = (response, status, value, headers) =>
  void response
    .writeHead(status, { ...plain, ...headers, 'Content-Type': 'application/json' })
    .end(JSON.stringify(value));

/**
 * What is answered to plain requests: the web client's files, the scene, /healthz and /metrics.
 * @param {{room: import('./room.js').Room, metrics: import('./metrics.js').Metrics, clientFolder: string,
 *          scene: Buffer, tokens?: import('./join_tokens.js').JoinTokens}} options
 */
export function createHandler({ room, metrics, clientFolder, scene, tokens }) {
  const files = readClient(clientFolder);
  const sceneAnswer = sceneFile(scene);
  const sendScene = async (request, response) => {
    const admitted = tokens ? await tokens.verify(tokenOf(request)) : { ticket: {} };
    if ('refused' in admitted) {
      metrics.refusedConnections.inc({ reason: admitted.refused });
      return sendJson(response, 401, { error: `the scene is for those with a link: ${admitted.text}` });
    }
    sendFile(request, response, sceneAnswer);
  };
  return async (request, response) => {
    if (request.method !== 'GET' && request.method !== 'HEAD')
      return sendJson(response.setHeader('Allow', 'GET, HEAD'), 405, { error: 'only GET and HEAD' });
    const path = pathOf(request);
    if (path === '/healthz')
      return sendJson(response, 200, { status: 'ok', server: room.hasServer, clients: room.clientCount });
    if (path === '/metrics') {
      const text = await metrics.registry.metrics();
      return void response
        .writeHead(200, { ...plain, 'Content-Type': metrics.registry.contentType })
        .end(text);
    }
    if (path === '/scene.glb') return sendScene(request, response);
    const file = files.get(path);
    if (file) return sendFile(request, response, file);
    sendJson(response, 404, { error: 'no such file' });
  };
}

/**
 * An HTTP server that gives nobody more than his share: see limits.js. Requests that are refused never reach `handler`.
 *
 * @param {{limits: import('./limits.js').Limits, gate: import('./gate.js').Gate,
 *          addresses: ReturnType<typeof import('./addresses.js').createAddressFinder>,
 *          refuse: import('./refusals.js').Refuse, hostIsOurs: (host: string | undefined) => boolean,
 *          certificate?: {cert: Buffer, key: Buffer}}} options
 * @param {import('node:http').RequestListener} handler
 */
export function createGuardedServer({ limits, gate, addresses, refuse, hostIsOurs, certificate }, handler) {
  const options = {
    headersTimeout: limits.headersTimeoutMs,
    requestTimeout: limits.headersTimeoutMs,
    keepAliveTimeout: limits.keepAliveTimeoutMs,
    maxHeaderSize: limits.maxHeaderBytes,
    // Node looks every 30 s otherwise, and what takes too long holds its place until then.
    connectionsCheckingInterval: 1000,
  };
  /** @type {import('node:http').RequestListener} */
  const guarded = (request, response) => {
    const visitor = addresses.visitor(request);
    if (!gate.requests(visitor, performance.now())) {
      refuse('requests', visitor, 'too many requests');
      return sendJson(
        response,
        429,
        { error: 'too many requests' },
        { 'Retry-After': '1', Connection: 'close' },
      );
    }
    if (!hostIsOurs(request.headers.host)) {
      refuse(
        'host',
        visitor,
        `the page is not served by the name ${String(request.headers.host).slice(0, 100)}`,
      );
      const error = 'this page is not served by that name: start signaling with --name for each that it has';
      return sendJson(response, 421, { error });
    }
    handler(request, response);
  };
  const http = certificate
    ? createSecureServer({ ...options, ...certificate, handshakeTimeout: limits.headersTimeoutMs }, guarded)
    : createServer(options, guarded);
  http.maxConnections = limits.maxTcpConnections;
  http.maxRequestsPerSocket = limits.maxRequestsPerConnection;
  http.timeout = limits.idleTimeoutMs;
  http.on('timeout', (socket) => {
    refuse('idle', addresses.visitorOf(socket.remoteAddress), 'a connection on which nothing moved');
    socket.destroy();
  });
  http.on('drop', (data) =>
    refuse('all_connections', addresses.visitorOf(data?.remoteAddress), 'too many connections in all'),
  );
  http.on('dropRequest', (_request, socket) => {
    refuse('pipelining', addresses.visitorOf(socket.remoteAddress), 'too many requests in one connection');
    socket.destroy();
  });
  http.on('connection', (socket) => watch(socket, { gate, addresses, refuse }));
  return http;
}

/** Counts a connection for its address while it lasts; a proxy's carry everybody's, and are not counted. */
function watch(socket, { gate, addresses, refuse }) {
  const { remoteAddress, remotePort } = socket;
  if (addresses.isProxy(remoteAddress)) return;
  const visitor = addresses.visitorOf(remoteAddress);
  const key = connectionKey(socket);
  const { refused, evicted } = gate.connects(visitor, key, socket, performance.now());
  if (evicted) refuse(evicted, visitor, 'too many connections: the oldest was ended');
  if (refused) {
    refuse(refused, visitor, refused === 'arrivals' ? 'connections too fast' : 'too many connections');
    return socket.destroy();
  }
  if (remotePort === undefined) return socket.destroy(); // it has ended meanwhile
  socket.once('close', () => gate.disconnects(visitor, key));
}

/** @type {(socket: {remoteAddress?: string, remotePort?: number}) => string} the same for TLS and what is below it */
export const connectionKey = ({ remoteAddress, remotePort }) => `${remoteAddress} ${remotePort}`;

import { createServer } from 'node:http';
import { createServer as createTlsServer } from 'node:https';
import { AddressGate } from './address_gate.js';
import { createAddresses } from './addresses.js';
import { Doorman } from './doorman.js';
import { createHosts } from './hosts.js';
import { createIce } from './ice.js';
import { createJoinTokens } from './join_tokens.js';
import { limitsWith } from './limits.js';
import { Refusals, limitedLog } from './log.js';
import { createMetrics } from './metrics.js';
import { Relay } from './relay.js';
import { createHandler } from './requests.js';
import { Room } from './room.js';
import { readTls, watchTls } from './tls.js';
import { createUpgrades } from './upgrades.js';

/**
 * Starts the signaling server: /server for the render server, /client for browsers, the web client's files,
 * /scene.glb, /healthz and /metrics.
 *
 * @param {{host: string, port: number, token: string, clientFolder: string, scene: Buffer,
 *          allowedOrigins?: string[], names?: string[], trustedProxies?: string[], joinSecret?: string | undefined,
 *          iceServers?: string[], turnSecret?: string | undefined, tls?: import('./tls.js').TlsFiles | undefined,
 *          limits?: Partial<import('./limits.js').Limits>, log?: (line: string) => void}} options
 *   port 0 takes a free one; the others are as on the command line (options.js)
 * @returns {Promise<{port: number, close: () => Promise<void>}>} rejects with the system's error (EADDRINUSE, ...), or with
 *   an InputError that says which option is wrong
 */
export async function startSignaling({ log = () => {}, allowedOrigins = [], ...options }) {
  const limits = limitsWith(options.limits);
  const ice = createIce(options.iceServers ?? [], options.turnSecret, limits.turnLifetimeSeconds);
  const addresses = createAddresses(options.trustedProxies);
  const hosts = createHosts(options.names);
  const { joinSecret } = options;
  const joinTokens = joinSecret === undefined ? undefined : createJoinTokens(joinSecret, limits);

  const room = new Room(ice.serversFor);
  const gate = new AddressGate(limits);
  const metrics = createMetrics(room, gate);
  const refusals = new Refusals(log, limits);
  const doorman = new Doorman({ gate, addresses, limits, metrics, refusals });
  const relay = new Relay({ room, metrics, gate, limits, log: limitedLog(log, limits) });

  const { clientFolder, scene, token } = options;
  const shared = { room, metrics, refusals, gate, doorman, addresses, hosts, joinTokens, relay, limits };
  const handle = createHandler({ ...shared, clientFolder, scene });
  const upgrade = createUpgrades({ ...shared, allowedOrigins, token });
  // What fails there is our fault and fails for one peer: everybody else goes on.
  const failed = (stream) => (error) => {
    // Where, not what: its message may hold what was sent, which may be a token.
    const where = error.stack?.match(/^ +at .*/m)?.[0].trim() ?? '';
    const text = `an answer could not be made: ${error.code ?? error.name} ${where}`;
    refusals.note(metrics.droppedConnections, 'internal_error', 'unknown', text);
    stream.destroy();
  };

  const pair = options.tls && readTls(options.tls);
  const http = createHttpServer(pair, limits);
  doorman.guard(http);
  http.on('request', (request, response) => {
    // All requests of one chunk come here, also when the first of them have ended the connection.
    if (!request.socket.destroyed) handle(request, response).catch(failed(response));
  });
  http.on('upgrade', (request, socket, head) => upgrade(request, socket, head).catch(failed(socket)));
  await new Promise((resolve, reject) => {
    http.once('error', reject);
    http.listen(options.port, options.host, () => resolve(undefined));
  });

  const beat = () => {
    relay.heartbeat();
    gate.forget(performance.now());
  };
  const timers = [setInterval(beat, limits.pingIntervalMs)];
  if (ice.refreshMs) timers.push(setInterval(() => relay.renewIceServers(), ice.refreshMs).unref());
  if (options.tls && pair) {
    const use = (renewed) => /** @type {import('node:https').Server} */ (http).setSecureContext(renewed);
    timers.push(watchTls(options.tls, pair, use, log, limits.certificatePollMs));
  }

  return {
    port: /** @type {import('node:net').AddressInfo} */ (http.address()).port,
    async close() {
      for (const timer of timers) clearInterval(timer);
      refusals.close();
      const closed = new Promise((resolve) => http.close(resolve));
      relay.close();
      doorman.close();
      setTimeout(() => http.closeAllConnections(), limits.closeTimeoutMs).unref();
      http.closeIdleConnections();
      await closed;
    },
  };
}

/** @type {(pair: import('./tls.js').Pair | undefined, limits: import('./limits.js').Limits) => import('node:http').Server} */
function createHttpServer(pair, limits) {
  const options = {
    maxHeaderSize: limits.maxHeaderBytes,
    headersTimeout: limits.headersTimeoutMs,
    requestTimeout: Math.max(limits.requestTimeoutMs, limits.headersTimeoutMs),
    keepAliveTimeout: limits.keepAliveTimeoutMs,
    connectionsCheckingInterval: 1000, // Node's own is 30 s, by which the two above would be late
  };
  const http = pair
    ? createTlsServer({
        ...options,
        cert: pair.cert,
        key: pair.key,
        handshakeTimeout: limits.tlsHandshakeTimeoutMs,
      })
    : createServer(options);
  http.timeout = limits.answerTimeoutMs;
  http.maxRequestsPerSocket = limits.maxRequestsPerConnection;
  return http;
}

import { sendJson } from './answers.js';
import { readClient, sceneFile, sendFile } from './static.js';

/** @type {(request: import('node:http').IncomingMessage) => string} */
export const pathOf = (request) => (request.url ?? '/').split('?', 1)[0];

/**
 * The plain HTTP side: the web client's files, /scene.glb, /healthz and /metrics.
 *
 * @param {{room: import('./room.js').Room, metrics: import('./metrics.js').Metrics,
 *          refusals: import('./log.js').Refusals, doorman: import('./doorman.js').Doorman,
 *          addresses: import('./addresses.js').Addresses, hosts: import('./hosts.js').Hosts,
 *          joinTokens?: import('./join_tokens.js').JoinTokens, limits: import('./limits.js').Limits,
 *          clientFolder: string, scene: Buffer}} options
 * @returns {(request: import('node:http').IncomingMessage, response: import('node:http').ServerResponse) => Promise<void>}
 */
export function createHandler(options) {
  const { room, metrics, refusals, doorman, addresses, hosts, joinTokens, limits } = options;
  const files = readClient(options.clientFolder, limits);
  const scene = sceneFile(options.scene, joinTokens !== undefined);

  /** @type {(request: any, response: any, status: number, reason: string, error: string, headers?: object) => void} */
  const refuse = (request, response, status, reason, error, headers) => {
    refusals.note(metrics.refusedRequests, reason, addresses.ofRequest(request), error);
    sendJson(response, status, { error }, headers);
  };

  return async (request, response) => {
    if (!doorman.admitsRequest(request, response)) return;
    if (request.method !== 'GET' && request.method !== 'HEAD')
      // Whatever body comes with it is not waited for.
      return sendJson(
        response,
        405,
        { error: 'only GET and HEAD' },
        { Allow: 'GET, HEAD', Connection: 'close' },
      );
    const path = pathOf(request);
    // For health checks and scrapers, which ask by whatever name they know. They say nothing that a page could misuse.
    if (path === '/healthz')
      return sendJson(response, 200, { status: 'ok', server: room.hasServer, clients: room.clientCount });
    if (path === '/metrics') {
      const text = await metrics.registry.metrics();
      const headers = { 'Content-Type': metrics.registry.contentType, 'Cache-Control': 'no-store' };
      return void response.writeHead(200, { ...headers, 'X-Content-Type-Options': 'nosniff' }).end(text);
    }
    const misnamed = hosts.refusal(request.headers.host);
    if (misnamed) return refuse(request, response, 421, 'host', misnamed);
    if (path === '/scene.glb') {
      const { refused } = (await joinTokens?.ofRequest(request)) ?? {};
      if (!refused) return sendFile(request, response, scene, limits);
      return refuse(request, response, 401, 'join_token', refused, { 'WWW-Authenticate': 'Bearer' });
    }
    const file = files.get(decoded(path));
    if (file) return sendFile(request, response, file, limits);
    sendJson(response, 404, { error: 'no such file' });
  };
}

/** @type {(path: string) => string} */
function decoded(path) {
  try {
    return decodeURIComponent(path);
  } catch {
    return ''; // no file has that name
  }
}

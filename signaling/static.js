import { createHash } from 'node:crypto';
import sirv from 'sirv';

// 'wasm-unsafe-eval' and the like are left out on purpose: the client needs scripts of its own host only. `blob:` is
// how glTF's embedded textures are loaded.
const securityHeaders = {
  'Content-Security-Policy':
    "default-src 'self'; connect-src 'self' blob:; img-src 'self' blob: data:; object-src 'none'; " +
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
  'X-Content-Type-Options': 'nosniff',
  'Referrer-Policy': 'no-referrer',
  'Cross-Origin-Opener-Policy': 'same-origin',
};

/**
 * The web client's files. They are listed once, at the start, and only what is listed is ever served.
 * @param {string} folder  a built web client
 */
export function serveClient(folder) {
  return sirv(folder, {
    etag: true,
    setHeaders(response, path) {
      for (const [name, value] of Object.entries(securityHeaders)) response.setHeader(name, value);
      // Vite puts a hash of the content into the names below assets/: those never change.
      const cache = path.startsWith('/assets/') ? 'public, max-age=31536000, immutable' : 'no-cache';
      response.setHeader('Cache-Control', cache);
    },
  });
}

/**
 * The scene, read once, so that every client sees the same bytes.
 * @param {Buffer} bytes
 */
export function serveScene(bytes) {
  const etag = `"${createHash('sha256').update(bytes).digest('hex')}"`;
  /** @type {(request: import('node:http').IncomingMessage, response: import('node:http').ServerResponse) => void} */
  return (request, response) => {
    const headers = { ETag: etag, 'Cache-Control': 'no-cache', 'X-Content-Type-Options': 'nosniff' };
    if (request.headers['if-none-match'] === etag) return void response.writeHead(304, headers).end();
    response.writeHead(200, {
      ...headers,
      'Content-Type': 'model/gltf-binary',
      'Content-Length': bytes.length,
    });
    response.end(request.method === 'HEAD' ? undefined : bytes);
  };
}

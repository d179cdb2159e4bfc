import { createHash, timingSafeEqual } from 'node:crypto';
import { STATUS_CODES } from 'node:http';

/** @type {(text: string) => Buffer} */
const digest = (text) => createHash('sha256').update(text).digest();

/**
 * Compares in constant time (the digests have equal lengths whatever was sent).
 * @param {import('node:http').IncomingMessage} request
 * @param {string} token
 */
export function hasToken(request, token) {
  return timingSafeEqual(digest(request.headers.authorization ?? ''), digest(`Bearer ${token}`));
}

/**
 * Browsers always say which page a WebSocket comes from; only our own may join. Other programs send no Origin.
 * @param {import('node:http').IncomingMessage} request
 * @param {string[]} allowedOrigins  beside the host that was asked itself, e.g. "https://example.org"
 */
export function hasGoodOrigin(request, allowedOrigins) {
  const { origin, host } = request.headers;
  if (origin === undefined || allowedOrigins.includes(origin)) return true;
  try {
    return new URL(origin).host === host;
  } catch {
    return false;
  }
}

/**
 * @param {import('node:http').IncomingMessage} request
 * @returns {string | undefined} the 64 hex digits of the header Lichtveld-Scene
 */
export function sceneHash(request) {
  const value = request.headers['lichtveld-scene'];
  return typeof value === 'string' && /^[0-9a-f]{64}$/i.test(value) ? value.toLowerCase() : undefined;
}

/**
 * Answers an upgrade with an HTTP error and ends the connection.
 * @param {import('node:stream').Duplex} socket
 * @param {number} status
 * @param {string} error  for people
 */
export function refuseUpgrade(socket, status, error) {
  const body = JSON.stringify({ error });
  socket.on('error', () => socket.destroy());
  // It stays half open and has no timeout after an upgrade: who never ends its side would keep its place.
  socket.once('finish', () => socket.destroy());
  socket.end(
    `HTTP/1.1 ${status} ${STATUS_CODES[status]}\r\nConnection: close\r\nContent-Type: application/json\r\n` +
      `Content-Length: ${Buffer.byteLength(body)}\r\n\r\n${body}`,
  );
}

import { createHash, timingSafeEqual } from 'node:crypto';

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
    return new URL(origin).host === host?.toLowerCase();
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

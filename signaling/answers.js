import { STATUS_CODES } from 'node:http';

/** Headers of whatever is said about the moment. */
export const plainHeaders = Object.freeze({
  'Cache-Control': 'no-store',
  'X-Content-Type-Options': 'nosniff',
});

/**
 * @param {import('node:http').ServerResponse} response
 * @param {number} status
 * @param {object} value
 * @param {import('node:http').OutgoingHttpHeaders} [headers]  beside the usual ones
 */
export function sendJson(response, status, value, headers = {}) {
  const body = JSON.stringify(value);
  response
    .writeHead(status, {
      ...plainHeaders,
      'Content-Type': 'application/json',
      ...headers,
      'Content-Length': Buffer.byteLength(body),
    })
    .end(body);
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

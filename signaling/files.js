import { createHash } from 'node:crypto';
import { readFileSync, readdirSync } from 'node:fs';
import { join, relative, sep } from 'node:path';
import { Readable, pipeline } from 'node:stream';
import { lookup } from 'mrmime';

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

/** Bytes that are handed on at a time: a connection that does not read holds this many, however large the file. */
const sliceBytes = 64 * 1024;

/** @typedef {{bytes: Buffer, headers: Record<string, string>}} File */

/** @type {(bytes: Buffer, headers: Record<string, string>) => File} */
const fileOf = (bytes, headers) => ({
  bytes,
  headers: { ...headers, ETag: `"${createHash('sha256').update(bytes).digest('base64url')}"` },
});

/**
 * The web client's files by their paths. They are few and small, and read once, at the start: nothing else is ever
 * served, and no request opens a file.
 * @param {string} folder  a built web client
 * @returns {Map<string, File>}
 */
export function readClient(folder) {
  const files = new Map();
  for (const entry of readdirSync(folder, { recursive: true, withFileTypes: true })) {
    if (!entry.isFile()) continue;
    const path = join(entry.parentPath ?? entry.path, entry.name);
    const url = `/${relative(folder, path).split(sep).join('/')}`;
    const type = lookup(url) ?? 'application/octet-stream';
    const file = fileOf(readFileSync(path), {
      ...securityHeaders,
      'Content-Type': type.startsWith('text/') ? `${type};charset=utf-8` : type,
      // Vite puts a hash of the content into the names below assets/: those never change.
      'Cache-Control': url.startsWith('/assets/') ? 'public, max-age=31536000, immutable' : 'no-cache',
    });
    files.set(url, file);
    if (url === '/index.html') files.set('/', file);
  }
  return files;
}

/** The scene, read once, so that every client sees the same bytes. @type {(bytes: Buffer) => File} */
export const sceneFile = (bytes) =>
  fileOf(bytes, {
    'Content-Type': 'model/gltf-binary',
    'Cache-Control': 'no-cache',
    'X-Content-Type-Options': 'nosniff',
  });

function* slices(bytes) {
  for (let at = 0; at < bytes.length; at += sliceBytes) yield bytes.subarray(at, at + sliceBytes);
}

/**
 * Sends a file as fast as it is read, and ends with its connection.
 * @param {import('node:http').IncomingMessage} request
 * @param {import('node:http').ServerResponse} response
 * @param {File} file
 */
export function sendFile(request, response, { bytes, headers }) {
  if (request.headers['if-none-match'] === headers['ETag']) {
    const { 'Content-Type': _, ...rest } = headers;
    return void response.writeHead(304, rest).end();
  }
  response.writeHead(200, { ...headers, 'Content-Length': bytes.length });
  if (request.method === 'HEAD' || bytes.length === 0) return void response.end();
  pipeline(
    Readable.from(slices(bytes), { objectMode: false, highWaterMark: sliceBytes }),
    response,
    () => {},
  );
}

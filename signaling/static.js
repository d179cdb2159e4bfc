import { createHash } from 'node:crypto';
import { readFileSync, readdirSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { Readable, pipeline } from 'node:stream';
import { lookup } from 'mrmime';
import { InputError, reading } from './input.js';

/** @typedef {{bytes: Buffer, headers: import('node:http').OutgoingHttpHeaders & {ETag: string}}} File */

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

/** @type {(bytes: Buffer, headers: import('node:http').OutgoingHttpHeaders) => File} */
const toFile = (bytes, headers) => ({
  bytes,
  headers: { ...headers, ETag: `"${createHash('sha256').update(bytes).digest('hex')}"` },
});

/**
 * The web client's files by their paths, read once: a page costs no file descriptor, and only what was there at the start
 * is ever served. Links and hidden files are left out.
 * @param {string} folder  a built web client
 * @param {import('./limits.js').Limits} limits
 * @returns {Map<string, File>}
 */
export function readClient(folder, { maxClientBytes }) {
  /** @type {Map<string, File>} */
  const files = new Map();
  let bytes = 0;
  /** @type {(path: string) => void} path  below the folder, without a slash at its end */
  const readFolder = (path) => {
    const inside = join(folder, path);
    for (const entry of reading('client', inside, () => readdirSync(inside, { withFileTypes: true }))) {
      const name = `${path}/${entry.name}`;
      const file = join(folder, name);
      if (entry.name.startsWith('.')) continue;
      if (entry.isDirectory()) readFolder(name);
      if (!entry.isFile()) continue;
      bytes += reading('client', file, () => statSync(file)).size;
      if (bytes > maxClientBytes)
        throw new InputError(
          `the client ${folder} has more than ${maxClientBytes} bytes, which are kept in memory: give the built web client with --client`,
        );
      const type = lookup(name) ?? 'application/octet-stream';
      const page = toFile(
        reading('client', file, () => readFileSync(file)),
        {
          ...securityHeaders,
          'Content-Type': type.startsWith('text/') ? `${type};charset=utf-8` : type,
          // Vite puts a hash of the content into the names below assets/: those never change.
          'Cache-Control': name.startsWith('/assets/') ? 'public, max-age=31536000, immutable' : 'no-cache',
        },
      );
      files.set(name, page);
      if (entry.name === 'index.html') files.set(`${path}/`, page);
    }
  };
  readFolder('');
  return files;
}

/**
 * The scene, read once, so that every client sees the same bytes.
 * @param {Buffer} bytes
 * @param {boolean} isPrivate  is it for those with a token only?
 */
export function sceneFile(bytes, isPrivate) {
  return toFile(bytes, {
    'Content-Type': 'model/gltf-binary',
    'Cache-Control': isPrivate ? 'private, no-cache' : 'no-cache',
    'X-Content-Type-Options': 'nosniff',
    ...(isPrivate && { Vary: 'Authorization' }),
  });
}

/**
 * Sends a file as fast as it is read. A connection holds one slice of it, which is no copy, and all of it ends with its
 * connection.
 * @param {import('node:http').IncomingMessage} request
 * @param {import('node:http').ServerResponse} response
 * @param {File} file
 * @param {import('./limits.js').Limits} limits
 */
export function sendFile(request, response, { bytes, headers }, { sliceBytes }) {
  if (hasTag(request.headers['if-none-match'], headers.ETag)) {
    const { 'Content-Type': _, ...others } = headers;
    return void response.writeHead(304, others).end();
  }
  response.writeHead(200, { ...headers, 'Content-Length': bytes.length });
  if (request.method === 'HEAD') return void response.end();
  // Who leaves in the middle is nobody's fault: pipeline has ended both sides, and that is all there is to do.
  pipeline(Readable.from(slices(bytes, sliceBytes)), response, () => {});
}

/** @type {(bytes: Buffer, length: number) => Generator<Buffer>} */
function* slices(bytes, length) {
  for (let at = 0; at < bytes.length; at += length) yield bytes.subarray(at, at + length);
}

/** RFC 9110, section 13.1.2: a list of tags, weak ones are as good. @type {(list: string | undefined, tag: string) => boolean} */
const hasTag = (list, tag) =>
  list?.split(',').some((one) => [tag, '*'].includes(one.trim().replace(/^W\//, ''))) ?? false;

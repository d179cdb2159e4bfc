#!/usr/bin/env node
import { createHash } from 'node:crypto';
import { readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { defaultLimits } from './limits.js';
import { startSignaling } from './server.js';

const usage = `node signaling/main.js --token-file FILE --client FOLDER --scene FILE.glb [options]
  --host ADDRESS            to listen on (127.0.0.1; 0.0.0.0 for everybody)
  --port NUMBER             to listen on (8080; 0 takes a free one)
  --token-file FILE         the secret that the render server shows
  --client FOLDER           the built web client
  --scene FILE              the scene that the clients draw
  --allow-origin ORIGIN     a page of another host that may join, e.g. https://example.org (may be repeated)
  --max-clients NUMBER      connected at once (${defaultLimits.maxClients})
  --max-per-address NUMBER  connected at once from one address (${defaultLimits.maxClientsPerAddress}; behind a proxy
                            everybody has the proxy's)
Exit codes: 0 ended by a signal, 2 bad usage or input, 1 anything else.`;

class InputError extends Error {}

/** @type {(text: string, name: string, max: number) => number} */
function toNumber(text, name, max) {
  if (/^\d{1,9}$/.test(text) && Number(text) <= max) return Number(text);
  throw new InputError(`${name} wants a whole number from 0 to ${max}, not '${text}'`);
}

/** @template T @param {string} what @param {string} path @param {() => T} read @returns {T} */
function reading(what, path, read) {
  try {
    return read();
  } catch (error) {
    throw new InputError(
      `cannot read the ${what} ${path}: ${error.code ?? error.message}; give another with --${what}`,
    );
  }
}

/** The only word of the file, by the render server's idea of white space. @type {(path: string) => string} */
function readToken(path) {
  const text = reading('token-file', path, () => readFileSync(path, 'utf8'));
  const words = text.split(/[ \t\n\v\f\r]+/).filter((word) => word !== '');
  if (words.length === 0)
    throw new InputError(`the token file ${path} is empty: write a long random word into it`);
  if (words.length > 1)
    throw new InputError(`the token file ${path} has white space within the token: write one long random word`);
  return words[0];
}

/** @type {(path: string) => Buffer} */
function readScene(path) {
  const bytes = reading('scene', path, () => readFileSync(path));
  if (bytes.toString('latin1', 0, 4) !== 'glTF')
    throw new InputError(`the scene ${path} is no binary glTF file: give a .glb with --scene`);
  return bytes;
}

function readOptions() {
  let values;
  try {
    ({ values } = parseArgs({
      options: {
        host: { type: 'string', default: '127.0.0.1' },
        port: { type: 'string', default: '8080' },
        'token-file': { type: 'string' },
        client: { type: 'string' },
        scene: { type: 'string' },
        'allow-origin': { type: 'string', multiple: true, default: [] },
        'max-clients': { type: 'string', default: String(defaultLimits.maxClients) },
        'max-per-address': { type: 'string', default: String(defaultLimits.maxClientsPerAddress) },
        help: { type: 'boolean', short: 'h' },
      },
    }));
  } catch (error) {
    throw new InputError(`${error.message}\n${usage}`);
  }
  if (values.help) {
    console.log(usage);
    process.exit(0);
  }
  for (const name of ['token-file', 'client', 'scene'])
    if (!values[name]) throw new InputError(`--${name} is missing\n${usage}`);

  const token = readToken(values['token-file']);
  const page = join(values.client, 'index.html');
  if (!reading('client', page, () => statSync(page)).isFile())
    throw new InputError(`${page} is no file: build the web client (npm run build --workspace web-client)`);
  return {
    host: values.host,
    port: toNumber(values.port, '--port', 65535),
    token,
    clientFolder: values.client,
    scene: readScene(values.scene),
    allowedOrigins: values['allow-origin'],
    limits: {
      maxClients: toNumber(values['max-clients'], '--max-clients', 100_000),
      maxClientsPerAddress: toNumber(values['max-per-address'], '--max-per-address', 100_000),
    },
  };
}

/** What to try when listening fails; these are the caller's input, not our fault. */
const listenErrors = {
  EADDRINUSE: 'is taken: end what listens there, or choose another with --port',
  EADDRNOTAVAIL: 'is not an address of this machine: choose another with --host',
  EACCES: 'needs privileges: choose a port above 1023 with --port',
  ENOTFOUND: 'is no known host: choose another with --host',
};

try {
  const options = readOptions();
  const log = (line) => console.error(`signaling: ${line}`);
  const signaling = await startSignaling({ ...options, log }).catch((error) => {
    const hint = listenErrors[error.code];
    throw hint ? new InputError(`port ${options.port} on ${options.host} ${hint}`) : error;
  });
  for (const signal of ['SIGINT', 'SIGTERM'])
    process.once(signal, () => signaling.close().then(() => process.exit(0)));
  const address = options.host.includes(':') ? `[${options.host}]` : options.host;
  log(`scene sha256 ${createHash('sha256').update(options.scene).digest('hex')}`);
  console.log(`signaling listens on http://${address}:${signaling.port}`);
} catch (error) {
  console.error(`signaling: ${error instanceof InputError ? error.message : (error.stack ?? error)}`);
  process.exit(error instanceof InputError ? 2 : 1);
}

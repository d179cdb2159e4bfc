import { readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { createAddressFinder } from './addresses.js';
import { kindOfIceServer } from './ice.js';
import { minSecretLength } from './join_tokens.js';
import { defaultLimits } from './limits.js';
import { readCertificate } from './tls.js';

const usage = `node signaling/main.js --token-file FILE --client FOLDER --scene FILE.glb [options]
  --host ADDRESS            to listen on (127.0.0.1; 0.0.0.0 for everybody)
  --port NUMBER             to listen on (8080; 0 takes a free one)
  --token-file FILE         the secret that the render server shows
  --client FOLDER           the built web client
  --scene FILE              the scene that the clients draw
Who may join:
  --name HOST               a name by which the page is served, e.g. room.example.org (may be repeated; addresses,
                            localhost and this machine's own name are always good)
  --allow-origin ORIGIN     a page of another host that may join, e.g. https://example.org (may be repeated)
  --join-secret-file FILE   lets in only those with a link made by signaling/link.js with the same secret
Encryption:
  --tls-cert FILE           the certificate (PEM, with its chain) for https and wss; read anew when it is renewed
  --tls-key FILE            its key
  --trust-proxy ADDRESS     a proxy whose X-Forwarded-For is believed: an address, a network or 'loopback' (may be
                            repeated)
Ways through NATs:
  --ice-server URL          stun:HOST[:PORT], turn:HOST[:PORT][?transport=tcp] or turns:... (may be repeated)
  --turn-secret-file FILE   the secret that coturn knows as static-auth-secret; TURN wants it
Limits:
  --max-clients NUMBER      connected at once (${defaultLimits.maxClients})
  --max-per-address NUMBER  connected at once from one address (${defaultLimits.maxClientsPerAddress})
Exit codes: 0 ended by a signal, 2 bad usage or input, 1 anything else.`;

/** Bad usage or input: its message is all that people need. */
export class InputError extends Error {}

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

/**
 * The only word of a secret's file, by the render server's idea of white space.
 * @type {(option: string, path: string) => string}
 */
function readSecret(option, path) {
  const what = option.replace('-file', '').replace('-', ' ');
  const text = reading(option, path, () => readFileSync(path, 'utf8'));
  const words = text.split(/[ \t\n\v\f\r]+/).filter((word) => word !== '');
  if (words.length === 0)
    throw new InputError(`the ${what} file ${path} is empty: write a long random word into it`);
  if (words.length > 1)
    throw new InputError(
      `the ${what} file ${path} has white space within the ${what}: write one long random word`,
    );
  return words[0];
}

/** The secret by which links are signed. @type {(path: string) => string} */
export function readJoinSecret(path) {
  const secret = readSecret('join-secret-file', path);
  if (secret.length < minSecretLength)
    throw new InputError(
      `the secret in ${path} is shorter than ${minSecretLength} characters, and could be guessed: make one with ` +
        `openssl rand -hex 32 > ${path}`,
    );
  return secret;
}

/** @type {(path: string) => Buffer} */
function readScene(path) {
  const bytes = reading('scene', path, () => readFileSync(path));
  if (bytes.toString('latin1', 0, 4) !== 'glTF')
    throw new InputError(`the scene ${path} is no binary glTF file: give a .glb with --scene`);
  return bytes;
}

function readTls({ 'tls-cert': cert, 'tls-key': key }) {
  if (cert === undefined && key === undefined) return undefined;
  if (cert === undefined || key === undefined)
    throw new InputError('--tls-cert and --tls-key belong together: give both');
  try {
    readCertificate({ cert, key });
  } catch (error) {
    throw new InputError(error.message);
  }
  return { cert, key };
}

function readIceServers({ 'ice-server': urls, 'turn-secret-file': secretFile }) {
  for (const url of urls)
    if (!kindOfIceServer(url))
      throw new InputError(
        `--ice-server ${url}: it looks like stun:HOST:PORT, turn:HOST:PORT or turns:HOST:PORT`,
      );
  const turn = urls.find((url) => kindOfIceServer(url) === 'turn');
  if (turn && secretFile === undefined)
    throw new InputError(
      `--ice-server ${turn} wants --turn-secret-file, the secret that the TURN server knows`,
    );
  const turnSecret = secretFile === undefined ? undefined : readSecret('turn-secret-file', secretFile);
  return { iceUrls: urls, turnSecret };
}

function checkProxies(proxies) {
  try {
    createAddressFinder(proxies);
  } catch (error) {
    throw new InputError(
      `--trust-proxy: ${error.message}; give an address, a network such as 10.0.0.0/8, or loopback`,
    );
  }
  return proxies;
}

/** @type {(name: string) => string} */
function checkName(name) {
  if (/^[\w.-]{1,253}$/.test(name)) return name;
  throw new InputError(`--name ${name}: give a host name alone, such as room.example.org`);
}

/** @template T @param {() => T} parse @param {string} help @returns {T} */
export function parsing(parse, help) {
  try {
    return parse();
  } catch (error) {
    throw new InputError(`${error.message}\n${help}`);
  }
}

/** Reads the command line and the files that it names; throws InputError. */
export function readOptions() {
  const { values } = parsing(
    () =>
      parseArgs({
        options: {
          host: { type: 'string', default: '127.0.0.1' },
          port: { type: 'string', default: '8080' },
          'token-file': { type: 'string' },
          client: { type: 'string' },
          scene: { type: 'string' },
          name: { type: 'string', multiple: true, default: [] },
          'allow-origin': { type: 'string', multiple: true, default: [] },
          'join-secret-file': { type: 'string' },
          'tls-cert': { type: 'string' },
          'tls-key': { type: 'string' },
          'trust-proxy': { type: 'string', multiple: true, default: [] },
          'ice-server': { type: 'string', multiple: true, default: [] },
          'turn-secret-file': { type: 'string' },
          'max-clients': { type: 'string', default: String(defaultLimits.maxClients) },
          'max-per-address': { type: 'string', default: String(defaultLimits.maxClientsPerAddress) },
          help: { type: 'boolean', short: 'h' },
        },
      }),
    usage,
  );
  if (values.help) {
    console.log(usage);
    process.exit(0);
  }
  for (const name of ['token-file', 'client', 'scene'])
    if (!values[name]) throw new InputError(`--${name} is missing\n${usage}`);

  const page = join(values.client, 'index.html');
  if (!reading('client', page, () => statSync(page)).isFile())
    throw new InputError(`${page} is no file: build the web client (npm run build --workspace web-client)`);
  return {
    host: values.host,
    port: toNumber(values.port, '--port', 65535),
    token: readSecret('token-file', values['token-file']),
    clientFolder: values.client,
    scene: readScene(values.scene),
    names: values.name.map(checkName),
    allowedOrigins: values['allow-origin'],
    joinSecret: values['join-secret-file'] && readJoinSecret(values['join-secret-file']),
    tls: readTls(values),
    proxies: checkProxies(values['trust-proxy']),
    ...readIceServers(values),
    limits: {
      maxClients: toNumber(values['max-clients'], '--max-clients', 100_000),
      maxClientsPerAddress: toNumber(values['max-per-address'], '--max-per-address', 100_000),
    },
  };
}

import { readFileSync, statSync } from 'node:fs';
import { isIP } from 'node:net';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { InputError, readSecret, reading, toNumber } from './input.js';
import { minSecretLength } from './join_tokens.js';
import { defaultLimits } from './limits.js';

export const usage = `node signaling/main.js --token-file FILE --client FOLDER --scene FILE.glb [options]
  --host ADDRESS            to listen on (127.0.0.1; 0.0.0.0 for everybody)
  --port NUMBER             to listen on (8080; 0 takes a free one)
  --token-file FILE         the secret that the render server shows
  --client FOLDER           the built web client
  --scene FILE              the scene that the clients draw

 On the internet
  --name HOST               a name that the page is served by (may be repeated). Addresses, localhost, this machine's own
                            name and that of --host always are; who asks by another one is refused
  --tls-cert FILE           PEM, with its chain: https and wss. Read anew when it changes; sessions go on
  --tls-key FILE            PEM, its key
  --trust-proxy ADDRESS     a proxy whose X-Forwarded-For is believed: an address, a range like 10.0.0.0/8, or loopback
                            (may be repeated)
  --ice-server URL          stun:, turn: or turns:, for both sides (may be repeated)
  --turn-secret-file FILE   the secret that coturn has as static-auth-secret: credentials of it last an hour

 Who may join
  --join-secret-file FILE   only who has a link of signaling/link.js, made with the same file
  --allow-origin ORIGIN     a page of another host that may join, e.g. https://example.org (may be repeated)
  --max-clients NUMBER      connected at once (${defaultLimits.maxClients})
  --max-per-address NUMBER  connected at once from one address (${defaultLimits.maxClientsPerAddress})
  --limit NAME=VALUE        another limit of signaling/limits.js: a number, or a rate as PER_SECOND/BURST (may be repeated)
Exit codes: 0 ended by a signal, 2 bad usage or input, 1 anything else.`;

/** @type {string[]} */
const none = [];
const options = /** @type {const} */ ({
  host: { type: 'string', default: '127.0.0.1' },
  port: { type: 'string', default: '8080' },
  'token-file': { type: 'string' },
  client: { type: 'string' },
  scene: { type: 'string' },
  name: { type: 'string', multiple: true, default: none },
  'tls-cert': { type: 'string' },
  'tls-key': { type: 'string' },
  'trust-proxy': { type: 'string', multiple: true, default: none },
  'ice-server': { type: 'string', multiple: true, default: none },
  'turn-secret-file': { type: 'string' },
  'join-secret-file': { type: 'string' },
  'allow-origin': { type: 'string', multiple: true, default: none },
  'max-clients': { type: 'string', default: String(defaultLimits.maxClients) },
  'max-per-address': { type: 'string', default: String(defaultLimits.maxClientsPerAddress) },
  limit: { type: 'string', multiple: true, default: none },
  help: { type: 'boolean', short: 'h' },
});

/**
 * @param {string[]} args  of the command line
 * @returns what startSignaling wants; undefined when help is asked for
 */
export function readOptions(args) {
  /** @type {Record<string, any>} */
  let values;
  try {
    ({ values } = parseArgs({ args, options }));
  } catch (error) {
    throw new InputError(`${error.message}\n${usage}`);
  }
  if (values.help) return undefined;
  for (const name of ['token-file', 'client', 'scene'])
    if (!values[name]) throw new InputError(`--${name} is missing\n${usage}`);

  const token = readSecret('token-file', values['token-file']);
  const page = join(values.client, 'index.html');
  if (!reading('client', page, () => statSync(page)).isFile())
    throw new InputError(`${page} is no file: build the web client (npm run build --workspace web-client)`);
  return {
    host: values.host,
    port: toNumber(values.port, '--port', 65535),
    token,
    clientFolder: values.client,
    scene: readScene(values.scene),
    names: isIP(values.host) || values.host === '' ? values.name : [...values.name, values.host],
    tls: tlsFiles(values['tls-cert'], values['tls-key']),
    trustedProxies: values['trust-proxy'],
    iceServers: values['ice-server'],
    turnSecret: values['turn-secret-file'] && readSecret('turn-secret-file', values['turn-secret-file']),
    joinSecret:
      values['join-secret-file'] &&
      readSecret('join-secret-file', values['join-secret-file'], minSecretLength),
    allowedOrigins: values['allow-origin'],
    limits: {
      ...Object.fromEntries(values.limit.map(readLimit)),
      maxClients: toNumber(values['max-clients'], '--max-clients', 100_000),
      maxClientsPerAddress: toNumber(values['max-per-address'], '--max-per-address', 100_000),
    },
  };
}

/** @type {(path: string) => Buffer} */
function readScene(path) {
  const bytes = reading('scene', path, () => readFileSync(path));
  if (bytes.toString('latin1', 0, 4) !== 'glTF')
    throw new InputError(`the scene ${path} is no binary glTF file: give a .glb with --scene`);
  return bytes;
}

/** @type {(cert: string | undefined, key: string | undefined) => import('./tls.js').TlsFiles | undefined} */
function tlsFiles(cert, key) {
  if (cert && key) return { cert, key };
  if (!cert && !key) return undefined;
  throw new InputError(`--tls-cert and --tls-key belong together: --tls-${cert ? 'key' : 'cert'} is missing`);
}

/** @type {(text: string) => [string, number | import('./limits.js').Rate]} */
function readLimit(text) {
  const [, name = '', value = '', , burst] = text.match(/^(\w+)=(\d{1,9}(\.\d+)?)(?:\/(\d{1,9}))?$/) ?? [];
  const known = Object.hasOwn(defaultLimits, name) ? defaultLimits[name] : undefined;
  const wantsRate = typeof known === 'object';
  if (known === undefined || wantsRate !== (burst !== undefined) || (!wantsRate && value.includes('.')))
    throw new InputError(
      `--limit wants a name of signaling/limits.js with a whole number or a rate, such as maxTcpConnections=2048 or ` +
        `clientRate=10/100, not '${text}'`,
    );
  return [name, wantsRate ? { perSecond: Number(value), burst: Number(burst) } : Number(value)];
}

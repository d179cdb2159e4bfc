import { X509Certificate, createPrivateKey } from 'node:crypto';
import { readFileSync, statSync } from 'node:fs';
import { createSecureContext } from 'node:tls';
import { InputError, reading } from './input.js';

/**
 * @typedef {{cert: string, key: string}} TlsFiles  paths of PEM files; the certificate's may hold its chain
 * @typedef {{cert: Buffer, key: Buffer, ends: number}} Pair  for tls.createSecureContext; `ends` in milliseconds since 1970
 */

/**
 * Reads a certificate and its key, and checks what would otherwise show at the first visitor only.
 * @param {TlsFiles} files
 * @param {number} [now]  milliseconds since 1970
 * @returns {Pair}
 */
export function readTls({ cert: certPath, key: keyPath }, now = Date.now()) {
  const cert = reading('tls-cert', certPath, () => readFileSync(certPath));
  const key = reading('tls-key', keyPath, () => readFileSync(keyPath));
  const certificate = parsing('--tls-cert', certPath, 'a certificate', () => new X509Certificate(cert));
  const privateKey = parsing('--tls-key', keyPath, 'a private key without a passphrase', () =>
    createPrivateKey(key),
  );
  if (!certificate.checkPrivateKey(privateKey))
    throw new InputError(
      `the key ${keyPath} does not belong to the certificate ${certPath}: give both of one pair`,
    );
  if (now > Date.parse(certificate.validTo))
    throw new InputError(`the certificate ${certPath} expired on ${certificate.validTo}: renew it`);
  if (now < Date.parse(certificate.validFrom))
    throw new InputError(
      `the certificate ${certPath} is not valid before ${certificate.validFrom}: look at this machine's clock`,
    );
  parsing('--tls-cert', certPath, 'a chain of certificates', () => createSecureContext({ cert, key }));
  return { cert, key, ends: Date.parse(certificate.validTo) };
}

/**
 * Looks again and again whether the files have changed, as certbot and the like change them: no handshake fails for it
 * and no session ends. A pair that is no good is told once, and the one in use stays.
 * @param {TlsFiles} files
 * @param {Pair} pair  in use
 * @param {(pair: Pair) => void} use
 * @param {(line: string) => void} log
 * @param {number} pollMs
 * @returns {NodeJS.Timeout} for clearInterval
 */
export function watchTls(files, pair, use, log, pollMs) {
  let seen = stateOf(files);
  let { ends } = pair;
  let told = '';
  const tell = (/** @type {string} */ line) => {
    if (line !== told) log(line);
    told = line;
  };
  const look = () => {
    const state = stateOf(files);
    // What was no good is tried again: the key may come a little after its certificate.
    if (state !== seen || told !== '') {
      seen = state;
      const renewed = readTls(files);
      use(renewed);
      ({ ends } = renewed);
      told = '';
      log(`reads the renewed certificate ${files.cert}`);
    } else if (Date.now() > ends) readTls(files); // which says so
  };
  return setInterval(() => {
    try {
      look();
    } catch (error) {
      tell(`goes on with the old certificate: ${error.message}`);
    }
  }, pollMs).unref();
}

/** Text that differs when a file has been written or replaced. @type {(files: TlsFiles) => string} */
function stateOf({ cert, key }) {
  const states = [cert, key].map((path) => {
    const { ino, size, mtimeMs } = statSync(path, { throwIfNoEntry: false }) ?? {};
    return `${ino} ${size} ${mtimeMs}`;
  });
  return states.join();
}

/** @template T @param {string} option @param {string} path @param {string} what @param {() => T} parse @returns {T} */
function parsing(option, path, what, parse) {
  try {
    return parse();
  } catch {
    // OpenSSL's own words name neither the file nor the trouble.
    throw new InputError(`${path} is not ${what} in PEM: give another with ${option}`);
  }
}

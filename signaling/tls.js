import { X509Certificate } from 'node:crypto';
import { readFileSync, watchFile, unwatchFile } from 'node:fs';
import { createSecureContext } from 'node:tls';

/**
 * Reads a certificate (with its chain) and its key, PEM.
 * @param {{cert: string, key: string}} files
 * @returns {{cert: Buffer, key: Buffer}}  throws Error with a sentence for people
 */
export function readCertificate({ cert: certFile, key: keyFile }) {
  const read = (option, path) => {
    try {
      return readFileSync(path);
    } catch (error) {
      throw new Error(
        `cannot read the ${option} ${path}: ${error.code ?? error.message}; give another with --${option}`,
      );
    }
  };
  const [cert, key] = [read('tls-cert', certFile), read('tls-key', keyFile)];
  let first;
  try {
    first = new X509Certificate(cert);
  } catch {
    throw new Error(`${certFile} holds no certificate: --tls-cert wants a PEM file, with the chain after it`);
  }
  const now = Date.now();
  if (Date.parse(first.validTo) < now)
    throw new Error(`the certificate ${certFile} expired on ${first.validTo}: renew it`);
  if (Date.parse(first.validFrom) > now)
    throw new Error(
      `the certificate ${certFile} is only good from ${first.validFrom} on: look at this machine's clock`,
    );
  try {
    createSecureContext({ cert, key });
  } catch (error) {
    throw new Error(
      `${keyFile} is no key of the certificate ${certFile} (${error.message}): give both of one pair`,
    );
  }
  return { cert, key };
}

/**
 * Takes a renewed certificate without ending a connection; one that is no good is left alone.
 * @param {{cert: string, key: string}} files
 * @param {import('node:https').Server} server
 * @param {(line: string) => void} log
 * @param {number} intervalMs  between two looks at the files
 * @returns {() => void} ends it
 */
export function watchCertificate(files, server, log, intervalMs) {
  const renew = () => {
    try {
      server.setSecureContext(readCertificate(files));
      log(`the certificate ${files.cert} was renewed`);
    } catch (error) {
      log(`the old certificate stays: ${error.message}`);
    }
  };
  const paths = [files.cert, files.key];
  for (const path of paths) watchFile(path, { interval: intervalMs, persistent: false }, renew);
  return () => paths.forEach((path) => unwatchFile(path, renew));
}

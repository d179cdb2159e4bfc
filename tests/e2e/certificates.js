import { execFileSync } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

/** A key without a pass phrase; its file's name follows. */
const newKey = ['-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:P-256', '-nodes', '-keyout'];

/**
 * A certificate authority in a folder, made with the openssl command, and certificates by it.
 * @param {string} folder
 */
export function makeAuthority(folder) {
  const openssl = (...args) => execFileSync('openssl', args, { cwd: folder, stdio: 'pipe' });
  const ca = join(folder, 'ca.pem');
  openssl('req', '-x509', ...newKey, 'ca.key', '-out', ca, '-days', '2', '-subj', '/CN=Lichtveld test CA');
  return {
    ca,
    /**
     * @param {string} name  of its files
     * @param {{names?: string, days?: string}} [options]  names: as in DNS:localhost,IP:127.0.0.1; days: may be negative
     * @returns {{cert: string, key: string}}
     */
    issue(name, { names = 'DNS:localhost,IP:127.0.0.1', days = '2' } = {}) {
      const [cert, key, request, extensions] = ['pem', 'key', 'csr', 'ext'].map((end) =>
        join(folder, `${name}.${end}`),
      );
      writeFileSync(extensions, `subjectAltName=${names}\n`);
      openssl('req', ...newKey, key, '-out', request, '-subj', `/CN=${name}`);
      openssl(
        'x509',
        '-req',
        '-in',
        request,
        '-CA',
        ca,
        '-CAkey',
        'ca.key',
        '-CAcreateserial',
        '-days',
        days,
        '-out',
        cert,
        '-extfile',
        extensions,
      );
      return { cert, key };
    },
  };
}

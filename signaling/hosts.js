import { isIP } from 'node:net';
import { hostname } from 'node:os';

/**
 * By which names the page may be asked for. A page of another name could have that name lead to us (DNS rebinding) and
 * would then be of our own origin to its visitor's browser, even on 127.0.0.1. Addresses cannot be led elsewhere.
 * @param {string[]} names  beside localhost and this machine's own
 * @returns {(host: string | undefined) => boolean} of a request's `Host`
 */
export function createHostCheck(names) {
  const own = hostname().toLowerCase();
  const known = new Set(['localhost', own, `${own}.local`, ...names.map((name) => name.toLowerCase())]);
  return (host) => {
    if (host === undefined) return true; // HTTP/1.0, which no browser speaks
    const name = host
      .toLowerCase()
      .replace(/:\d{1,5}$/, '')
      .replace(/\.$/, '');
    return known.has(name) || isIP(name.replace(/^\[(.*)\]$/, '$1')) !== 0;
  };
}

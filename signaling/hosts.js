import { isIP } from 'node:net';
import { hostname } from 'node:os';
import { InputError } from './input.js';

const namePattern = /^(?=.{1,253}$)[a-z0-9_]([a-z0-9_-]*[a-z0-9_])?(\.[a-z0-9_]([a-z0-9_-]*[a-z0-9_])?)*$/;

/** Without a final dot, which means nothing here. @type {(name: string) => string} */
const plain = (name) => name.toLowerCase().replace(/\.$/, '');

/**
 * The names by which the page may be asked for. A page of somebody else's can let its own name lead to our address (DNS
 * rebinding), and would then be same-origin with us: its browser sends that name as `Host`. Addresses cannot be misled.
 *
 * @param {string[]} [names]  beside localhost and this machine's own name
 */
export function createHosts(names = []) {
  for (const name of names)
    if (!namePattern.test(plain(name)))
      throw new InputError(
        `--name wants a host name such as room.example.org, without a port, not '${name}'`,
      );
  const own = plain(hostname());
  const allowed = new Set(['localhost', own, `${own.split('.')[0]}.local`, ...names.map(plain)]);
  return {
    /**
     * @param {string | undefined} host  the header
     * @returns {string | undefined} why it may not be, and what to do about it
     */
    refusal(host) {
      const [, address, name] = host?.match(/^(?:\[([0-9a-f:.]+)\]|([^[\]:/@\s]+))(?::\d{1,5})?$/i) ?? [];
      if (address !== undefined && isIP(address)) return undefined;
      if (name !== undefined && (isIP(name) || allowed.has(plain(name)))) return undefined;
      const asked = (name ?? host ?? '').slice(0, 100);
      return namePattern.test(plain(asked))
        ? `this page is not served as '${asked}': if that is its name, start signaling with --name ${asked}`
        : 'the request names no host that this page is served by: ask by a name given with --name, or by an address';
    },
  };
}

/** @typedef {ReturnType<typeof createHosts>} Hosts */

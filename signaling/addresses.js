import ipaddr from 'ipaddr.js';
import proxyAddr from 'proxy-addr';
import { InputError } from './input.js';

/**
 * What counts as one address. A home or a rented machine has a whole /64 of IPv6, so that is one; IPv4 that comes by an
 * IPv6 socket is IPv4.
 * @param {string | undefined} text
 * @returns {string | undefined} undefined for what is no address
 */
export function addressKey(text) {
  if (text === undefined || !ipaddr.isValid(text)) return undefined;
  const address = ipaddr.process(text);
  // Link-local neighbours share one prefix, and cannot choose their addresses from afar.
  if (address instanceof ipaddr.IPv4 || address.range() === 'linkLocal') return address.toString();
  return `${new ipaddr.IPv6([...address.parts.slice(0, 4), 0, 0, 0, 0])}/64`;
}

/**
 * Whom connections and requests come from. Of the proxies that are trusted, and of nobody else, X-Forwarded-For is
 * believed.
 * @param {string[]} [trusted]  addresses, ranges like 10.0.0.0/8, or `loopback`
 */
export function createAddresses(trusted = []) {
  /** @type {(address: string, hop: number) => boolean} */
  let isTrusted = () => false;
  try {
    if (trusted.length > 0) isTrusted = proxyAddr.compile(trusted);
  } catch {
    throw new InputError(
      `--trust-proxy wants addresses like 10.0.0.5, ranges like 10.0.0.0/8, or loopback, not '${trusted.join("', '")}'`,
    );
  }
  /** @type {(socket: {remoteAddress?: string | undefined}) => string} */
  const ofSocket = (socket) => addressKey(socket.remoteAddress) ?? 'unknown';
  return {
    ofSocket,
    /** @param {{remoteAddress?: string | undefined}} socket */
    isProxy: ({ remoteAddress }) => remoteAddress !== undefined && isTrusted(remoteAddress, 0),
    /** @param {import('node:http').IncomingMessage} request */
    ofRequest(request) {
      const { remoteAddress } = request.socket;
      if (remoteAddress === undefined || !isTrusted(remoteAddress, 0)) return ofSocket(request.socket);
      // A proxy that says nothing, or no address ("unknown"), is taken for the client itself: bounded, if too tightly.
      return addressKey(proxyAddr(request, isTrusted)) ?? ofSocket(request.socket);
    },
  };
}

/** @typedef {ReturnType<typeof createAddresses>} Addresses */

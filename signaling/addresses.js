import ipaddr from 'ipaddr.js';
import proxyAddr from 'proxy-addr';

/** Bits of an IPv6 address that stand for one customer: whoever has one address there has them all (RFC 6177). */
const customerBits = 64;

/**
 * Who comes from an address, for counting: IPv4 as it is, also when it is written as IPv6; of IPv6 the network.
 * @param {string | undefined} address
 * @returns {string}
 */
export function visitorOf(address) {
  if (!address || !ipaddr.isValid(address)) return 'unknown';
  const parsed = ipaddr.process(address);
  if (parsed.kind() === 'ipv4') return parsed.toString();
  const bytes = parsed.toByteArray().fill(0, customerBits / 8);
  return `${ipaddr.fromByteArray(bytes).toString()}/${customerBits}`;
}

/**
 * Finds the address that a request really comes from.
 * @param {string[]} proxies  addresses, networks (10.0.0.0/8) or names such as `loopback`, whose X-Forwarded-For is
 *   believed; throws TypeError for what is none of these
 */
export function createAddressFinder(proxies) {
  const trusts = proxies.length > 0 ? proxyAddr.compile(proxies) : () => false;
  return {
    /** Whether connections from this address carry the requests of others. @param {string | undefined} address */
    isProxy: (address) => address !== undefined && trusts(address, 0),
    visitorOf,
    /** @param {import('node:http').IncomingMessage} request */
    visitor: (request) => visitorOf(proxyAddr(request, trusts)),
  };
}

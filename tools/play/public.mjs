/** What a room on the internet needs besides: the address that others reach, and a TURN server. */
import { writeFileSync } from 'node:fs';
import { BlockList, isIP } from 'node:net';
import { networkInterfaces } from 'node:os';
import { join } from 'node:path';

/** IANA's port of STUN and TURN, UDP and TCP. */
export const turnPort = 3478;
/** UDP ports for players whose networks let nothing but TURN through: one each. */
const relayPorts = [49160, 49260];

/** Addresses that nobody outside can reach (RFC 1918, 6598, 3927). */
const unreachable = new BlockList();
for (const [network, bits] of /** @type {[string, number][]} */ ([
  ['10.0.0.0', 8],
  ['172.16.0.0', 12],
  ['192.168.0.0', 16],
  ['100.64.0.0', 10],
  ['169.254.0.0', 16],
  ['127.0.0.0', 8],
]))
  unreachable.addSubnet(network, bits, 'ipv4');

/** This machine's IPv4 addresses but loopback. */
function ownAddresses() {
  return Object.values(networkInterfaces())
    .flatMap((addresses) => addresses ?? [])
    .filter(({ family, internal }) => family === 'IPv4' && !internal)
    .map(({ address }) => address);
}

/**
 * The address by which the internet reaches this machine, and whether that is one of its own (else a 1:1 NAT stands
 * before it).
 * @param {string | undefined} told  by the user
 */
export function publicAddress(told) {
  const own = ownAddresses();
  if (told !== undefined) {
    if (isIP(told) !== 4) throw new Error(`--public-ip wants an IPv4 address, not '${told}'`);
    return { address: told, ours: own.includes(told), own };
  }
  const found = own.find((address) => !unreachable.check(address, 'ipv4'));
  if (!found)
    throw new Error(
      `this machine's own addresses (${own.join(', ') || 'none'}) are private: give the one by which the internet ` +
        'reaches it with --public-ip; its provider shows it',
    );
  return { address: found, ours: true, own };
}

/**
 * Writes the configuration of a coturn for this room alone: it relays to this machine and nowhere else, and only for
 * those who have a credential of our signaling server.
 * @param {{folder: string, secret: string, address: {address: string, ours: boolean, own: string[]}}} options
 * @returns {string} the file's path
 */
export function writeTurnConfiguration({ folder, secret, address }) {
  const lines = [
    `listening-port=${turnPort}`,
    ...(address.ours ? [] : [`external-ip=${address.address}`]),
    `min-port=${relayPorts[0]}`,
    `max-port=${relayPorts[1]}`,
    'realm=lichtveld',
    'use-auth-secret',
    `static-auth-secret=${secret}`,
    'no-tls',
    'no-dtls',
    'no-cli',
    'no-multicast-peers',
    'denied-peer-ip=0.0.0.0-255.255.255.255',
    'denied-peer-ip=::-ffff:ffff:ffff:ffff:ffff:ffff:ffff:ffff',
    ...address.own.map((own) => `allowed-peer-ip=${own}`),
    'user-quota=8',
    'stale-nonce=600',
    'log-file=stdout',
    'simple-log',
    `pidfile=${join(folder, 'turnserver.pid')}`,
    `userdb=${join(folder, 'turnserver.sqlite')}`,
  ];
  const path = join(folder, 'turnserver.conf');
  writeFileSync(path, `${lines.join('\n')}\n`, { mode: 0o600 });
  return path;
}

/** Where players ask for a way: STUN, and TURN over UDP and, where that is blocked, over TCP. */
export const iceServers = (address) => [
  `stun:${address}:${turnPort}`,
  `turn:${address}:${turnPort}`,
  `turn:${address}:${turnPort}?transport=tcp`,
];

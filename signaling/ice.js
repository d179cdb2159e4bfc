import { createHmac } from 'node:crypto';
import { InputError } from './input.js';

// RFC 7064 and 7065: no slashes, no user; a transport is for TURN only.
const pattern =
  /^(stun|turns?):(\[[0-9a-fA-F:.]+\]|[A-Za-z0-9._-]+)(?::(\d{1,5}))?(\?transport=(?:udp|tcp))?$/;

/**
 * The STUN and TURN servers that both sides are told of.
 *
 * @typedef {{urls: string[], username?: string, credential?: string}} IceServer  as RTCPeerConnection takes it
 *
 * @param {string[]} urls  of --ice-server
 * @param {string} [secret]  that coturn has as static-auth-secret
 * @param {number} [lifetimeSeconds]
 * @param {() => number} [now]  milliseconds since 1970
 */
export function createIce(urls, secret, lifetimeSeconds = 3600, now = Date.now) {
  for (const url of urls) {
    const [, scheme, , port, transport] = url.match(pattern) ?? [];
    if (!scheme || Number(port ?? 1) < 1 || Number(port ?? 1) > 65535 || (scheme === 'stun' && transport))
      throw new InputError(
        `--ice-server wants stun:HOST[:PORT], turn:HOST[:PORT][?transport=udp|tcp] or turns:.., not '${url}'`,
      );
  }
  const stun = urls.filter((url) => url.startsWith('stun:'));
  const turn = urls.filter((url) => !url.startsWith('stun:'));
  if (turn.length > 0 && !secret)
    throw new InputError(
      `--ice-server ${turn[0]} wants --turn-secret-file too: the secret that is coturn's static-auth-secret`,
    );
  if (turn.length === 0 && secret)
    throw new InputError('--turn-secret-file is for turn: servers, and none is given with --ice-server');

  return {
    /** After so long the render server, which stays, is told anew; undefined when nothing expires. */
    refreshMs: turn.length > 0 ? (lifetimeSeconds * 1000) / 2 : undefined,
    /**
     * What a peer is told. The name says when it ends and whose it is, the password proves that we said so
     * (draft-uberti-behave-turn-rest-00, which is coturn's use-auth-secret).
     * @param {string} id
     * @returns {IceServer[] | undefined}
     */
    serversFor(id) {
      if (urls.length === 0) return undefined;
      const servers = /** @type {IceServer[]} */ (stun.length > 0 ? [{ urls: stun }] : []);
      if (turn.length === 0 || !secret) return servers;
      const username = `${Math.floor(now() / 1000) + lifetimeSeconds}:${id}`;
      const credential = createHmac('sha1', secret).update(username).digest('base64');
      return [...servers, { urls: turn, username, credential }];
    },
  };
}

/** @typedef {ReturnType<typeof createIce>} Ice */

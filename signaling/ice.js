import { createHmac } from 'node:crypto';

/** host, [v6] or host:port after the scheme; TURN may name its transport (RFC 7064 and 7065). */
const pattern =
  /^(?:(stuns?):(?:\[[\da-f:]+\]|[\w.-]+)(?::\d{1,5})?|(turns?):(?:\[[\da-f:]+\]|[\w.-]+)(?::\d{1,5})?(?:\?transport=(?:udp|tcp))?)$/i;

/** @type {(url: string) => 'stun' | 'turn' | undefined} nothing for what is no address of either */
export function kindOfIceServer(url) {
  const match = pattern.exec(url);
  return match && (match[1] ? 'stun' : 'turn');
}

/**
 * The STUN and TURN servers that both sides find a way with, in the form that browsers take.
 *
 * TURN credentials are those of coturn's `use-auth-secret` (draft-uberti-behave-turn-rest): the user's name starts with
 * the time at which it expires, and the password is the name's HMAC-SHA1 by the secret that coturn shares with us.
 *
 * @param {{urls: string[], turnSecret?: string, lifetimeMs: number}} options  turnSecret: wanted for TURN
 * @returns {(id: string, now?: number) => object[]}  for the peer of this id; `now` in milliseconds since 1970
 */
export function createIceServers({ urls, turnSecret, lifetimeMs }) {
  const stun = urls.filter((url) => kindOfIceServer(url) === 'stun');
  const turn = urls.filter((url) => kindOfIceServer(url) === 'turn');
  return (id, now = Date.now()) => {
    const servers = [];
    if (stun.length > 0) servers.push({ urls: stun });
    if (turn.length > 0 && turnSecret) {
      const username = `${Math.floor((now + lifetimeMs) / 1000)}:${id}`;
      const credential = createHmac('sha1', turnSecret).update(username).digest('base64');
      servers.push({ urls: turn, username, credential });
    }
    return servers;
  };
}

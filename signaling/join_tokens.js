import { createSecretKey } from 'node:crypto';
import { SignJWT, errors, jwtVerify } from 'jose';

const audience = 'lichtveld';
const algorithm = 'HS256';
/** Characters of a secret: 32 random hex digits are 128 bits. */
export const minSecretLength = 32;
/** Characters of a token; ours have some 200. */
const maxTokenLength = 2000;
const maxNameLength = 40;
const subProtocolOfToken = 'lichtveld.join.';

/** The sub-protocol that a page speaks when it shows a token, which it cannot do by a header. */
export const subProtocol = 'lichtveld.signaling';

/**
 * What a token allows.
 * @typedef {{seat?: 'watcher', name?: string}} Ticket  without seat: a player
 */

/** @type {(name: unknown) => boolean} a name that does no harm in a log or on a page */
export const isName = (name) =>
  typeof name === 'string' &&
  name.length > 0 &&
  name.length <= maxNameLength &&
  /^[\p{L}\p{N} ._'-]+$/u.test(name);

/** The token that a request shows: in a page's sub-protocols, or as other programs do. */
export function tokenOf(request) {
  const protocols = String(request.headers['sec-websocket-protocol'] ?? '').split(',');
  const shown = protocols.map((text) => text.trim()).find((text) => text.startsWith(subProtocolOfToken));
  if (shown) return shown.slice(subProtocolOfToken.length);
  return /^Bearer ([\w.-]+)$/i.exec(request.headers.authorization ?? '')?.[1];
}

/** Signs and checks the tokens of links (JSON Web Tokens, RFC 7519). */
export class JoinTokens {
  #key;

  /** @param {string} secret  at least minSecretLength characters */
  constructor(secret) {
    this.#key = createSecretKey(Buffer.from(secret));
  }

  /**
   * @param {{role: 'player' | 'watcher', name?: string, hours: number}} options
   * @returns {Promise<string>}
   */
  sign({ role, name, hours }) {
    return new SignJWT({ role, ...(name !== undefined && { name }) })
      .setProtectedHeader({ alg: algorithm })
      .setAudience(audience)
      .setIssuedAt()
      .setExpirationTime(new Date(Date.now() + hours * 3600_000))
      .sign(this.#key);
  }

  /**
   * @param {string | undefined} token
   * @returns {Promise<{ticket: Ticket} | {refused: string, text: string}>} `text` for people
   */
  async verify(token) {
    if (!token) return { refused: 'no_token', text: 'it lets in those with a link only' };
    const bad = { refused: 'bad_token', text: 'your link is not for this room' };
    if (token.length > maxTokenLength) return bad;
    try {
      const options = { algorithms: [algorithm], audience, requiredClaims: ['exp', 'role'] };
      const { payload } = await jwtVerify(token, this.#key, options);
      const { role, name } = payload;
      if (role !== 'player' && role !== 'watcher') return bad;
      if (name !== undefined && !isName(name)) return bad;
      return {
        ticket: {
          ...(role === 'watcher' && { seat: /** @type {const} */ ('watcher') }),
          ...(name !== undefined && { name: String(name) }),
        },
      };
    } catch (error) {
      if (error instanceof errors.JWTExpired)
        return { refused: 'stale_token', text: 'your link has expired' };
      return bad;
    }
  }
}

import { createSecretKey } from 'node:crypto';
import { SignJWT, errors, jwtVerify } from 'jose';

/** Fewer characters could be guessed by trying, with one token at hand. 32 hex digits are 128 bits. */
export const minSecretLength = 32;

const audience = 'lichtveld';
const protocolPrefix = 'lichtveld.join.';
/** What clients that show a token in this way ask for besides: the relay may answer with one that was asked for only. */
export const protocolName = 'lichtveld.signaling';

export const seats = Object.freeze(['player', 'watcher']);
/** Characters of a name, the same for everybody who shows it. */
export const maxNameLength = 40;

// Control characters, halves of characters, line breaks, and what turns the direction of the text around it.
const unprintable = /[\p{Cc}\p{Cs}\p{Zl}\p{Zp}\u202a-\u202e\u2066-\u2069]/u;

/** @type {(name: unknown) => boolean} */
export const isName = (name) =>
  typeof name === 'string' && name.trim() !== '' && name.length <= maxNameLength && !unprintable.test(name);

/**
 * Links into a room that is not open to everybody: each carries a JWT, signed with a secret that signaling alone knows.
 *
 * @typedef {{role: string, name?: string | undefined}} Pass
 * @typedef {{pass: Pass, refused?: undefined} | {refused: string, pass?: undefined}} Verdict  `refused` for people
 *
 * @param {string} secret
 * @param {import('./limits.js').Limits} limits
 */
export function createJoinTokens(secret, { maxJoinTokenLength }) {
  const key = createSecretKey(Buffer.from(secret, 'utf8'));

  /** @type {(token: string | undefined) => Promise<Verdict>} */
  const verify = async (token) => {
    if (!token) return { refused: 'no token: ask whoever runs the room for a link' };
    const foreign = { refused: 'the link is not for this room: ask whoever runs the room for another' };
    if (token.length > maxJoinTokenLength) return foreign;
    try {
      const { payload } = await jwtVerify(token, key, {
        algorithms: ['HS256'], // and nothing that the token itself asks for
        audience,
        requiredClaims: ['exp', 'role'],
      });
      const { role, name } = payload;
      if (typeof role !== 'string' || !seats.includes(role)) return foreign;
      if (name !== undefined && !isName(name)) return foreign;
      return { pass: { role, name: /** @type {string | undefined} */ (name) } };
    } catch (error) {
      return error instanceof errors.JWTExpired
        ? { refused: 'the link has expired: ask whoever runs the room for another' }
        : foreign;
    }
  };

  return {
    /**
     * @param {Pass} pass
     * @param {number} hours  that the link is good for
     */
    sign: ({ role, name }, hours) =>
      new SignJWT({ role, ...(name !== undefined && { name }) })
        .setProtectedHeader({ alg: 'HS256' })
        .setAudience(audience)
        .setIssuedAt()
        .setExpirationTime(Math.floor(Date.now() / 1000 + hours * 3600))
        .sign(key),
    /** @param {import('node:http').IncomingMessage} request  a browser can put a token into the sub-protocols only */
    ofRequest: (request) => verify(tokenOf(request)),
  };
}

/** @typedef {ReturnType<typeof createJoinTokens>} JoinTokens */

/** @type {(request: import('node:http').IncomingMessage) => string | undefined} */
function tokenOf({ headers }) {
  const [, bearer] = headers.authorization?.match(/^Bearer +(\S+)$/i) ?? [];
  if (bearer) return bearer;
  const protocols = (headers['sec-websocket-protocol'] ?? '').split(',').map((protocol) => protocol.trim());
  return protocols.find((protocol) => protocol.startsWith(protocolPrefix))?.slice(protocolPrefix.length);
}

import { TokenBucket } from './token_bucket.js';

/**
 * How much one visitor (an address, see addresses.js) may have at once and a second, so that none can take the place of
 * all others. Pure: time is told.
 *
 * @typedef {{destroy: () => void}} Evictable
 * @typedef {{connections: Map<string, Evictable | undefined>, arrivals: TokenBucket, requests: TokenBucket,
 *            joins: TokenBucket, clients: number, seen: number}} Visitor
 */
export class Gate {
  #limits;
  /** @type {Map<string, Visitor>} */
  #visitors = new Map();

  /** @param {import('./limits.js').Limits} limits */
  constructor(limits) {
    this.#limits = limits;
  }

  /** Visitors that are remembered. */
  get size() {
    return this.#visitors.size;
  }

  /**
   * A TCP connection. Where the visitor has all that it may, its oldest one that is no WebSocket is ended: whoever comes
   * anew is more likely to be somebody than what has been hanging there.
   * @param {string} visitor
   * @param {string} key  of this connection
   * @param {Evictable} connection
   * @param {number} now  milliseconds of a steady clock, as everywhere here
   * @returns {{refused?: string, evicted?: string}}
   */
  connects(visitor, key, connection, now) {
    const known = this.#know(visitor, now);
    if (!known.arrivals.take(now)) return { refused: 'arrivals' };
    let evicted;
    if (known.connections.size >= this.#limits.maxConnectionsPerAddress) {
      const oldest = [...known.connections].find(([, candidate]) => candidate !== undefined);
      if (!oldest) return { refused: 'connections' };
      known.connections.delete(oldest[0]);
      oldest[1]?.destroy();
      evicted = 'connections';
    }
    known.connections.set(key, connection);
    return { evicted };
  }

  /** It has become a WebSocket, which has limits of its own. */
  upgrades(visitor, key) {
    const known = this.#visitors.get(visitor);
    if (known?.connections.has(key)) known.connections.set(key, undefined);
  }

  disconnects(visitor, key) {
    this.#visitors.get(visitor)?.connections.delete(key);
  }

  /** Whether a request is answered. */
  requests(visitor, now) {
    return this.#know(visitor, now).requests.take(now);
  }

  /** Whether an upgrade is looked at. */
  joins(visitor, now) {
    return this.#know(visitor, now).joins.take(now);
  }

  /** Whether there is a place for one more client of this visitor; if so it is taken. */
  enters(visitor, now) {
    const known = this.#know(visitor, now);
    if (known.clients >= this.#limits.maxClientsPerAddress) return false;
    known.clients += 1;
    return true;
  }

  leaves(visitor) {
    const known = this.#visitors.get(visitor);
    if (known) known.clients -= 1;
  }

  /** Forgets who has nothing here and has not been seen for a while: by then its buckets are full again. */
  forget(now) {
    for (const [visitor, { connections, clients, seen }] of this.#visitors)
      if (connections.size === 0 && clients === 0 && now - seen > this.#limits.visitorMemoryMs)
        this.#visitors.delete(visitor);
  }

  /** @returns {Visitor} */
  #know(visitor, now) {
    let known = this.#visitors.get(visitor);
    if (!known) {
      const { arrivalRate, requestRate, joinRate } = this.#limits;
      known = {
        connections: new Map(),
        arrivals: new TokenBucket(arrivalRate, now),
        requests: new TokenBucket(requestRate, now),
        joins: new TokenBucket(joinRate, now),
        clients: 0,
        seen: now,
      };
      this.#visitors.set(visitor, known);
    }
    known.seen = now;
    return known;
  }
}

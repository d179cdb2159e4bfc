import { TokenBucket } from './token_bucket.js';

/**
 * What each address has, and whether it may have more. Pure: the clock comes with each call, and what has to go is
 * answered. Connections and answers are any objects; the caller ends those that it is told to end.
 *
 * @template Connection
 * @template Answer
 */
export class AddressGate {
  /** By address, those that did something last at the end. @type {Map<string, Entry<Connection, Answer>>} */
  #entries = new Map();
  #limits;
  #connections = 0;

  /** @param {import('./limits.js').Limits} limits */
  constructor(limits) {
    this.#limits = limits;
  }

  get connections() {
    return this.#connections;
  }

  get addresses() {
    return this.#entries.size;
  }

  /**
   * A TCP connection comes. Another one may have to make room: the oldest of this address when it has its share, the
   * oldest of whichever address has most when everything is taken. Those that are WebSockets stay.
   * @param {string} address
   * @param {Connection} connection
   * @param {number} now  milliseconds of a steady clock, here and below
   * @param {boolean} [isProxy]  others speak through it: it has no share, only its part in all
   * @returns {{refused: string} | {evicted?: Connection, reason?: string}}
   */
  connects(address, connection, now, isProxy = false) {
    const entry = this.#entry(address, now);
    if (!isProxy && !entry.connectionBucket.take(now)) return { refused: 'connection_rate' };
    const full = !isProxy && entry.held >= this.#limits.maxConnectionsPerAddress;
    let evicted;
    if (full || this.#connections >= this.#limits.maxTcpConnections) {
      const holder = full ? entry : this.#fullest();
      if (!holder || holder.plain.size === 0)
        return { refused: full ? 'address_connections' : 'tcp_connections' };
      [evicted] = holder.plain;
      holder.plain.delete(/** @type {Connection} */ (evicted));
      this.#connections -= 1;
    }
    entry.plain.add(connection);
    this.#connections += 1;
    if (evicted === undefined) return {};
    return { evicted, reason: full ? 'address_connections' : 'tcp_connections' };
  }

  /**
   * From now on it does not make room for others.
   * @param {string} address
   * @param {Connection} connection
   */
  becomesWebSocket(address, connection) {
    const entry = this.#entries.get(address);
    if (entry?.plain.delete(connection)) entry.webSockets.add(connection);
  }

  /**
   * One that has been evicted or refused is gone already: that is no error.
   * @param {string} address
   * @param {Connection} connection
   */
  disconnects(address, connection) {
    const entry = this.#entries.get(address);
    if (entry?.plain.delete(connection) || entry?.webSockets.delete(connection)) this.#connections -= 1;
  }

  /**
   * It did what no browser does: its next connections come later, so that it cannot have the same work done at once again.
   * @param {string} address
   * @param {number} now
   */
  abuses(address, now) {
    const { connectionBucket, upgradeBucket } = this.#entry(address, now);
    connectionBucket.owe(this.#limits.connectionsPerAbuse, now);
    upgradeBucket.owe(this.#limits.upgradesPerAbuse, now);
  }

  /** @type {(address: string, now: number) => boolean} */
  mayRequest(address, now) {
    return this.#entry(address, now).requestBucket.take(now);
  }

  /** @type {(address: string, now: number) => boolean} */
  mayUpgrade(address, now) {
    return this.#entry(address, now).upgradeBucket.take(now);
  }

  /** @type {(address: string, now: number) => boolean} */
  mayOffer(address, now) {
    return this.#entry(address, now).offerBucket.take(now);
  }

  /**
   * An answer begins.
   * @param {string} address
   * @param {Answer} answer
   * @param {number} now
   * @returns {Answer | undefined} the oldest of this address, when that is one too many
   */
  answers(address, answer, now) {
    const { answers } = this.#entry(address, now);
    answers.add(answer);
    if (answers.size <= this.#limits.maxAnswersPerAddress) return undefined;
    const [oldest] = answers;
    answers.delete(oldest);
    return oldest;
  }

  /** @type {(address: string, answer: Answer) => void} */
  answered(address, answer) {
    this.#entries.get(address)?.answers.delete(answer);
  }

  /** @type {(address: string, now: number) => boolean} */
  mayJoin(address, now) {
    return this.#entry(address, now).clients < this.#limits.maxClientsPerAddress;
  }

  /** @type {(address: string, now: number) => void} */
  joins(address, now) {
    this.#entry(address, now).clients += 1;
  }

  /** @type {(address: string) => void} */
  leaves(address) {
    const entry = this.#entries.get(address);
    if (entry) entry.clients -= 1;
  }

  /**
   * Forgets the addresses that have nothing and whose rates are as good as new.
   * @param {number} now
   */
  forget(now) {
    for (const [address, entry] of this.#entries)
      if (!entry.isBusy && entry.isFresh(now)) this.#entries.delete(address);
  }

  #fullest() {
    let fullest;
    for (const entry of this.#entries.values())
      if (entry.plain.size > 0 && entry.held > (fullest?.held ?? 0)) fullest = entry;
    return fullest;
  }

  /** @type {(address: string, now: number) => Entry<Connection, Answer>} */
  #entry(address, now) {
    const known = this.#entries.get(address);
    const entry = known ?? new Entry(this.#limits, now);
    if (known) this.#entries.delete(address);
    else if (this.#entries.size >= this.#limits.maxAddresses) this.#forgetOldest();
    this.#entries.set(address, entry);
    return entry;
  }

  #forgetOldest() {
    for (const [address, entry] of this.#entries)
      if (!entry.isBusy) return void this.#entries.delete(address);
  }
}

/** @template Connection @template Answer */
class Entry {
  /** In the order in which they came. @type {Set<Connection>} */
  plain = new Set();
  /** @type {Set<Connection>} */
  webSockets = new Set();
  /** In the order in which they began. @type {Set<Answer>} */
  answers = new Set();
  /** Those who are in the room. */
  clients = 0;

  /**
   * @param {import('./limits.js').Limits} limits
   * @param {number} now
   */
  constructor(limits, now) {
    this.connectionBucket = new TokenBucket(limits.connectionRatePerAddress, now);
    this.requestBucket = new TokenBucket(limits.requestRatePerAddress, now);
    this.upgradeBucket = new TokenBucket(limits.upgradeRatePerAddress, now);
    this.offerBucket = new TokenBucket(limits.offerRatePerAddress, now);
  }

  get held() {
    return this.plain.size + this.webSockets.size;
  }

  get isBusy() {
    return this.held + this.answers.size + this.clients > 0;
  }

  /** @param {number} now */
  isFresh(now) {
    return [this.connectionBucket, this.requestBucket, this.upgradeBucket, this.offerBucket].every((bucket) =>
      bucket.isFull(now),
    );
  }
}

/**
 * Every limit of the signaling server, with its default and its reason. A data-channel-only session needs one offer
 * or answer of about 1 KiB and some ten candidates of about 100 bytes, once; everything here is generous to that and
 * tight to anything else.
 *
 * What an address may do is bounded apart from what all may do together, so that nobody can use up the others' share.
 * It is sized for a class behind one router: 32 browsers that open the page in the same second. With more clients an
 * address all its shares grow (limitsWith).
 *
 * @typedef {{perSecond: number, burst: number}} Rate  a token bucket: `burst` at once, refilled `perSecond`
 */
export const defaultLimits = Object.freeze({
  // --- messages ---
  /** Bytes of one WebSocket message. Larger ones close the connection (1009) before they are buffered. */
  maxMessageBytes: 16 * 1024,
  /** Characters of a session description; what ICE and DTLS need is about 1 KiB. */
  maxDescriptionLength: 12 * 1024,
  /** Characters of one ICE candidate line; IPv6 with all extensions stays below 250. */
  maxCandidateLength: 512,
  /** Characters of a media id; ours is "0". */
  maxMidLength: 16,
  /** Characters of a session's secret; 32 random bytes take 43. */
  maxSessionLength: 64,
  /** Players and watchers that a role message may name. */
  maxPeople: 100_000,
  /** Stages, passes and counts that the render server may report: it has up to twenty stages, and some forty counts. */
  maxWorkEntries: 64,
  /** Messages, pings and pongs of a client: a joining browser sends fewer than 40 in one go, then a pong each 5 s. */
  clientRate: Object.freeze({ perSecond: 10, burst: 100 }),
  /**
   * Bytes of a client, whatever they are: pieces of messages cost work too, and are no messages that could be counted.
   * The longest offer with 64 of the longest candidates has 50 KiB.
   */
  clientByteRate: Object.freeze({ perSecond: 16 * 1024, burst: 128 * 1024 }),
  /** Messages of the render server: a join tells everybody their role, and many may join at once. */
  serverRate: Object.freeze({ perSecond: 1000, burst: 5000 }),
  /** Refused messages after which a connection is closed (1008): more than a slip, fewer than an attack. */
  maxRefusals: 20,
  /** Bytes that may wait for a peer that does not read; beyond it the peer is dropped, so memory stays bounded. */
  maxBufferedBytes: 1024 * 1024,

  // --- who is there ---
  /** Clients connected at once: as many as the render server makes connections for. */
  maxClients: 64,
  /** Clients connected at once from one address: a class behind one router fits, a script cannot fill the room. */
  maxClientsPerAddress: 32,
  /**
   * WebSockets that an address may ask for, those included that are refused: a class comes, and comes again at once
   * when signaling was away; then ten a second, which is as fast as one client can join and leave.
   */
  upgradeRatePerAddress: Object.freeze({ perSecond: 10, burst: 64 }),
  /**
   * Offers from an address, beside the one that each client owes after a welcome: the render server takes 20 a second
   * from everybody together, and nobody may have them all.
   */
  offerRatePerAddress: Object.freeze({ perSecond: 1, burst: 32 }),
  /** Characters of a join token: ours have some 200. Longer ones are not looked at. */
  maxJoinTokenLength: 1024,

  // --- HTTP ---
  /** TCP connections at once, pages and files included. Another one takes the place of the oldest of whoever has most. */
  maxTcpConnections: 1024,
  /**
   * TCP connections at once from one address: a class with its pages and WebSockets, at most 7 each. Another one takes
   * the place of that address's oldest, WebSockets aside, so that an address recovers from what it has done.
   */
  maxConnectionsPerAddress: 256,
  /** TCP connections that an address may open: a class at once, and it has as many again after 13 s. */
  connectionRatePerAddress: Object.freeze({ perSecond: 20, burst: 256 }),
  /** Milliseconds until a connection beyond those is reset: whoever comes again at once comes once a second. */
  refusalDelayMs: 1000,
  /** Connections that wait for that, of all addresses; the oldest is reset for another. Each takes 64 KiB at most. */
  maxHeldRefusals: 1024,
  /** Requests of an address: a page is 5, so a class comes three times over; the refill is soon there for neighbours. */
  requestRatePerAddress: Object.freeze({ perSecond: 100, burst: 600 }),
  /** Answers under way to one address; only a proxy's clients can have more of them than connections. */
  maxAnswersPerAddress: 256,
  /** Requests of a connection that wait for their answers. Browsers and proxies send one after the other. */
  maxPipelinedRequests: 16,
  /**
   * What a connection with more of them costs of connectionRatePerAddress: one chunk of 64 KiB holds 1,700 requests,
   * which Node parses and takes back in 20 ms. So there are four such chunks at once, and one each 3 s.
   */
  connectionsPerAbuse: 64,
  /** The same of upgradeRatePerAddress, also for a WebSocket that is closed for what it sends: it may not come at once. */
  upgradesPerAbuse: 8,
  /** Requests of a connection before it has to be opened anew, which is bounded by address. */
  maxRequestsPerConnection: 100,
  /** Addresses that are remembered, for the rates above; those that do nothing are forgotten first. */
  maxAddresses: 4096,
  /** Bytes of a request's headers: cookies of other programs on this host come along. Node's default. */
  maxHeaderBytes: 16 * 1024,
  /** Milliseconds that a request may take to send its headers. They are looked at once a second. */
  headersTimeoutMs: 10_000,
  /** Milliseconds that a request may take in all: it has no body that we want. */
  requestTimeoutMs: 15_000,
  /** Milliseconds that a connection may wait for its next request; Node's default. */
  keepAliveTimeoutMs: 5000,
  /**
   * Milliseconds in which an answer makes no progress. The system's buffers take up to 3 MB, and a third of it has to
   * leave before we see any: with 30 s nobody is cut off whose line has 300 kbit/s.
   */
  answerTimeoutMs: 30_000,
  /** Bytes of an answer that are handed over at a time; the next ones wait until these are on their way. */
  sliceBytes: 64 * 1024,
  /** Bytes of the web client, which is kept in memory: it has 1 MB. Beyond it --client names another folder. */
  maxClientBytes: 64 * 1024 * 1024,

  // --- time ---
  /** Milliseconds between pings. */
  pingIntervalMs: 5000,
  /** Pings in a row that may stay unanswered: with 5 s a silent peer is gone after 10 to 15 s. */
  maxMissedPings: 2,
  /** Milliseconds that peers get to answer a close before their sockets are destroyed. */
  closeTimeoutMs: 500,
  /** Milliseconds that a TLS handshake may take. */
  tlsHandshakeTimeoutMs: 10_000,
  /** Milliseconds between two looks at the certificate's files. */
  certificatePollMs: 10_000,
  /** Seconds that TURN credentials are good for: a link that leaks is of little use, and a session outlives them. */
  turnLifetimeSeconds: 3600,
  /** Milliseconds for which refusals of one kind are gathered into one line of the log. */
  logIntervalMs: 5000,
  /** Lines about single peers in the log: a class that comes and goes, then one each 5 s. The rest is counted. */
  logRate: Object.freeze({ perSecond: 0.2, burst: 100 }),
});

/**
 * @typedef {typeof defaultLimits} Defaults
 * @typedef {{[Name in keyof Defaults]: Defaults[Name] extends number ? number : Rate}} Limits
 */

/**
 * The defaults with some of them changed. What an address may have is for maxClientsPerAddress: whoever lets it have more
 * clients wants them to be able to come, and to load the page.
 * @param {Partial<Limits>} [changes]
 * @returns {Limits}
 */
export function limitsWith(changes = {}) {
  const wanted = changes.maxClientsPerAddress ?? defaultLimits.maxClientsPerAddress;
  const factor = Math.max(1, wanted / defaultLimits.maxClientsPerAddress);
  const shares = Object.entries(defaultLimits)
    .filter(([name]) => name.endsWith('PerAddress'))
    .map(([name, share]) => [
      name,
      typeof share === 'number'
        ? Math.ceil(share * factor)
        : { perSecond: share.perSecond * factor, burst: Math.ceil(share.burst * factor) },
    ]);
  return { ...defaultLimits, ...Object.fromEntries(shares), ...changes };
}

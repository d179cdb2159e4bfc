/**
 * Every limit of the signaling server, with its default and its reason. A data-channel-only session needs one offer
 * or answer of about 1 KiB and some ten candidates of about 100 bytes, once; everything here is generous to that and
 * tight to anything else.
 *
 * @typedef {{perSecond: number, burst: number}} Rate  a token bucket: `burst` at once, refilled `perSecond`
 */
export const defaultLimits = Object.freeze({
  /** Bytes of one WebSocket message. Larger ones close the connection (1009) before they are buffered. */
  maxMessageBytes: 16 * 1024,
  /** Characters of a session description; what ICE and DTLS need is about 1 KiB. */
  maxDescriptionLength: 12 * 1024,
  /** Characters of one ICE candidate line; IPv6 with all extensions stays below 250. */
  maxCandidateLength: 512,
  /** Characters of a media id; ours is "0". */
  maxMidLength: 16,
  /** Players and watchers that a role message may name. */
  maxPeople: 100_000,
  /** Stages, passes and counts that the render server may report: it has up to thirty of each. */
  maxWorkEntries: 64,
  /** Characters of a stay's secret; the render server's have 36. */
  maxSessionLength: 64,

  /** Messages of a client: a joining browser sends fewer than 40 in one go, then none. */
  clientRate: Object.freeze({ perSecond: 10, burst: 100 }),
  /** Messages of the render server: a join tells everybody their role, and many may join at once. */
  serverRate: Object.freeze({ perSecond: 1000, burst: 5000 }),
  /** Refused messages after which a connection is closed (1008): more than a slip, fewer than an attack. */
  maxRefusals: 20,

  /** Clients connected at once: as many as the render server makes connections for. */
  maxClients: 64,
  /** Clients connected at once from one address: a class behind one router fits, a script cannot fill the room. */
  maxClientsPerAddress: 32,
  /** TCP connections at once, pages and files included; further ones are closed at once. */
  maxTcpConnections: 1024,
  /** Of these from one address: 32 browsers with the 7 connections that each may have; a quarter of all. */
  maxConnectionsPerAddress: 256,
  /** New TCP connections of an address: 32 browsers that load the page at once, then a few; more are closed unread. */
  arrivalRate: Object.freeze({ perSecond: 20, burst: 300 }),
  /** Requests of an address: a page is six, so this is 160 of them at once; one costs us some 50 us. */
  requestRate: Object.freeze({ perSecond: 100, burst: 1000 }),
  /** Attempts of an address to join, refused ones included: twice a full room's at once. Refusing is work, too. */
  joinRate: Object.freeze({ perSecond: 20, burst: 128 }),
  /** Milliseconds for which an address is remembered after it was seen last: until its buckets are full again. */
  visitorMemoryMs: 60_000,
  /** Requests of one connection; a browser's page needs six. One that sends more at once, unread, is cut off. */
  maxRequestsPerConnection: 100,
  /**
   * Milliseconds without a byte either way after which a connection ends (twice as many, at most, when an answer is under
   * way): answers that nobody reads go with it.
   */
  idleTimeoutMs: 10_000,
  /** Milliseconds for which a connection is kept for the next request. */
  keepAliveTimeoutMs: 5000,
  /** Bytes of a request's headers; a token in them has some 300. */
  maxHeaderBytes: 8 * 1024,
  /** Bytes that may wait for a peer that does not read; beyond it the peer is dropped, so memory stays bounded. */
  maxBufferedBytes: 1024 * 1024,

  /** Milliseconds between pings. */
  pingIntervalMs: 5000,
  /** Pings in a row that may stay unanswered: with 5 s a silent peer is gone after 10 to 15 s. */
  maxMissedPings: 2,
  /** Milliseconds that a request may take to send its headers, and a TLS handshake. */
  headersTimeoutMs: 10_000,
  /** Milliseconds between two looks whether the certificate was renewed, which happens weeks before its end. */
  certificateLookMs: 10_000,
  /** Milliseconds for which TURN credentials are good: to make a connection, which outlives them. */
  turnLifetimeMs: 3_600_000,
  /** Milliseconds that peers get to answer a close before their sockets are destroyed. */
  closeTimeoutMs: 500,
});

/**
 * @typedef {typeof defaultLimits} Defaults
 * @typedef {{[Name in keyof Defaults]: Defaults[Name] extends number ? number : Rate}} Limits
 */

/** The kinds of addresses by which two peers may reach each other (RFC 8445), and what to say when none of them did. */
export type Kind = 'host' | 'srflx' | 'prflx' | 'relay';

const kinds: readonly Kind[] = ['host', 'srflx', 'prflx', 'relay'];

const names: Readonly<Record<Kind, string>> = {
  host: 'its own address (host)',
  srflx: "its router's address (srflx)",
  prflx: 'an address found on the way (prflx)',
  relay: "a relay's address (relay)",
};

/** The kind that a candidate's line names. */
export function kindOf(line: string): Kind | undefined {
  const kind = / typ (\w+)/.exec(line)?.[1];
  return kinds.find((known) => known === kind);
}

export class Routes {
  /** Whether there is a TURN server to ask. */
  constructor(private readonly hasTurn: boolean) {}

  readonly #own = new Set<Kind>();
  readonly #theirs = new Set<Kind>();

  addOwn(line: string): void {
    add(this.#own, line);
  }

  /** Of one candidate, or of a description that holds some. */
  addTheirs(lines: string): void {
    for (const line of lines.split('\n')) add(this.#theirs, line);
  }

  /** Why no connection was made, and what to try: sentences for people, the last without its full stop. */
  describeFailure(): string {
    return (
      `no way to the render server was found. This browser offered ${list(this.#own)}, ` +
      `the server ${list(this.#theirs)}. ${this.#advice()}`
    );
  }

  #advice(): string {
    if (this.#own.size === 0)
      return 'Look whether a setting or an extension of this browser keeps WebRTC back';
    if (this.#theirs.size === 0)
      return "Who runs the room should look into the render server's log: it did not answer, or has no address";
    if (this.#own.has('relay') || this.#theirs.has('relay'))
      return 'Even the relay (TURN) did not help: who runs the room should look whether it runs and which ports are open';
    if (this.hasTurn)
      return "The room's relay (TURN) did not answer: who runs the room should look whether it runs and its port is open";
    return (
      "A router or firewall is in between: try another network, such as a phone's. " +
      'Who runs the room can let everybody in with a TURN server'
    );
  }
}

function add(set: Set<Kind>, line: string): void {
  const kind = kindOf(line);
  if (kind) set.add(kind);
}

function list(set: ReadonlySet<Kind>): string {
  const found = kinds.filter((kind) => set.has(kind)).map((kind) => names[kind]);
  return found.length > 0 ? found.join(' and ') : 'no address at all';
}

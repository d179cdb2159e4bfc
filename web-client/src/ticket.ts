/** What shows who we are: the link's token for the room, and the secret of an earlier stay for one's own cube. */

/** The token of a link like https://room.example.org/#join=TOKEN; a fragment is never sent with a request. */
export function joinToken(fragment: string): string | undefined {
  return /^#join=([\w.-]{1,2000})$/.exec(fragment)?.[1];
}

const key = 'lichtveld.session';

/**
 * The secret by which the server knows our stay again. It goes through the browser's storage only while the page is
 * reloaded: kept there, a second tab that is made from this one would take our place.
 */
export class StaySecret {
  #secret: string | undefined;

  /** Without a storage, which browsers may deny, a reload makes a newcomer of us. */
  constructor(private readonly storage: Pick<Storage, 'getItem' | 'setItem' | 'removeItem'> | undefined) {
    this.#secret = storage?.getItem(key) ?? undefined;
    storage?.removeItem(key);
  }

  get(): string | undefined {
    return this.#secret;
  }

  set(secret: string): void {
    this.#secret = secret;
  }

  /** The page goes, perhaps to come back. */
  keep(): void {
    if (this.#secret) this.storage?.setItem(key, this.#secret);
  }

  /** The page is back without having been loaded. */
  takeBack(): void {
    this.storage?.removeItem(key);
  }
}

/** The browser's storage of this tab; undefined where it is switched off. */
export function tabStorage(): Storage | undefined {
  try {
    return sessionStorage;
  } catch {
    return undefined;
  }
}

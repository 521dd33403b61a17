// Keeps name, token and resume key for the life of the tab, so that a reload within the server's grace time gets its boat back.
// They are never in the address, which ends up in histories and logs; the token of a link is removed from it. The resume key is stored only while no page uses it: a browser
// that duplicates a tab copies the store, and two pages with the same key would disconnect each other.
import type { Identity } from "../../client/session/events";

/** The part of Storage that is used. */
export interface StorageLike {
  getItem(key: string): string | null;
  setItem(key: string, value: string): void;
}

const kKey = "spindrift-identity";

/** Returns undefined where the browser forbids storage: reading the property throws there. */
export function sessionStorageIfAny(): StorageLike | undefined {
  try {
    return window.sessionStorage;
  } catch {
    return undefined;
  }
}

/** Without storage (private windows, some frames) nothing is kept, and everything else works. */
export class IdentityStore {
  constructor(
    private readonly storage: StorageLike | undefined,
    /** Server and room: resume keys are valid for one room only. */
    private readonly url: string,
  ) {}

  /** Returns the stored identity. `linkToken`: replaces the stored token. */
  peek(linkToken?: string): Identity {
    const stored = this.read();
    return { ...stored, token: linkToken ?? stored.token };
  }

  /** The same, and removes the resume key from the store. */
  load(linkToken?: string): Identity {
    const identity = this.peek(linkToken);
    this.save(identity);
    return identity;
  }

  /** Stores name and token. */
  save(identity: Identity): void {
    this.write({ ...identity, resumeKey: "" });
  }

  /** Stores the resume key as well: the page is closed or reloaded. */
  leave(identity: Identity): void {
    this.write(identity);
  }

  private read(): Identity {
    const none = { name: "", token: "", resumeKey: "" };
    try {
      const kept: unknown = JSON.parse(this.storage?.getItem(kKey) ?? "null");
      if (typeof kept !== "object" || kept === null) return none;
      const { name, token, resumeKey, url } = kept as Record<string, unknown>;
      const text = (value: unknown): string => (typeof value === "string" ? value : "");
      return { name: text(name), token: text(token), resumeKey: url === this.url ? text(resumeKey) : "" };
    } catch {
      return none;
    }
  }

  private write(identity: Identity): void {
    try {
      this.storage?.setItem(kKey, JSON.stringify({ ...identity, url: this.url }));
    } catch {
      // Full or forbidden: after a reload the server sees a new guest.
    }
  }
}

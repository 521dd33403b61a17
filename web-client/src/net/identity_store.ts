// Who this page is, kept for the tab's life: a reload within the server's grace time finds its boat again. Never in the
// address, which ends up in histories and logs. The key to one's place is in the store only while no page has it: a browser
// that duplicates the tab copies the store, and two pages with one key would push each other out.
import type { Identity } from "./messages";

/** The part of Storage that is used. */
export interface StorageLike {
  getItem(key: string): string | null;
  setItem(key: string, value: string): void;
}

const kKey = "spindrift-identity";

/** A browser without storage (private windows, some frames) keeps nothing, and everything else works. */
export class IdentityStore {
  constructor(
    private readonly storage: StorageLike | undefined,
    /** Keys are the server's and room's own. */
    private readonly url: string,
  ) {}

  /** Takes the key out of the store. */
  load(): Identity {
    const identity = this.read();
    this.save(identity);
    return identity;
  }

  /** Name and token. */
  save(identity: Identity): void {
    this.write({ ...identity, resumeKey: "" });
  }

  /** The page goes, perhaps to come back: the key stays for the next one. */
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
      // Full or forbidden: the next reload is a new guest.
    }
  }
}

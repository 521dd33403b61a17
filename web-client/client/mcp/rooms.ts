// The connections of an agent: one for each room that it uses, and the newest few of them.
import type { ConnectOptions } from "../water/connect";
import type { Water } from "../water/water";

const kMaxRooms = 4;

export class Rooms {
  /** By name, the one used last at the end. */
  private readonly opened = new Map<string, Promise<Water>>();

  constructor(
    readonly url: string,
    readonly token: string,
    private readonly connect: (url: string, options: ConnectOptions) => Promise<Water>,
  ) {}

  /** The room of this name; empty: that of the address, or the server's first one. Rejects as connect() does. */
  async water(room = ""): Promise<Water> {
    const opening = this.opened.get(room) ?? this.open(room);
    this.opened.delete(room);
    this.opened.set(room, opening);
    for (const [name, other] of [...this.opened].slice(0, -kMaxRooms)) this.forget(name, other);
    try {
      return await opening;
    } catch (error) {
      this.forget(room, opening);
      throw error;
    }
  }

  close(): void {
    for (const [name, opening] of this.opened) this.forget(name, opening);
  }

  private open(room: string): Promise<Water> {
    const opening = this.connect(this.url, { room, token: this.token, name: "agent", client: "spindrift-mcp" });
    opening.then((water) => water.on("closed", () => this.forget(room, opening)), () => {});
    return opening;
  }

  private forget(name: string, opening: Promise<Water>): void {
    if (this.opened.get(name) === opening) this.opened.delete(name);
    opening.then((water) => water.close(), () => {});
  }
}

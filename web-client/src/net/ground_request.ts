// The page asks for the ground of its room again whenever it changes.
import type { GroundGrid } from "../../client/codec/ground";

/** Asks for the ground of one room at a time. */
export class GroundRequests {
  private wantedRoom: string | undefined;
  private isAsking = false;

  /** `fail` gets a line for people. */
  constructor(
    private readonly request: (room: string) => Promise<GroundGrid>,
    private readonly take: (room: string, ground: GroundGrid) => void,
    private readonly fail: (message: string) => void,
  ) {}

  /** A slider asks many times per second: what is asked while an answer is awaited is asked once after it, and that answer, which is old, is not taken. */
  ask(room: string): void {
    this.wantedRoom = room;
    if (!this.isAsking) void this.askWanted();
  }

  private async askWanted(): Promise<void> {
    this.isAsking = true;
    while (this.wantedRoom !== undefined) {
      const room = this.wantedRoom;
      this.wantedRoom = undefined;
      try {
        const ground = await this.request(room);
        if (this.wantedRoom === undefined) this.take(room, ground);
      } catch (error) {
        if (this.wantedRoom === undefined) this.fail(error instanceof Error ? error.message : String(error));
      }
    }
    this.isAsking = false;
  }
}

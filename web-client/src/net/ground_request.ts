// The ground of a room: the worker asks the server for it and reads it, the page asks again when it changes.
import { readGround, type GroundGrid } from "../codec/ground";
import { isMalformed } from "../codec/malformed";
import { kNetTexts } from "./net_texts";

/** Throws an Error with a line for people if the room has no ground or it cannot be read. `address`: of the ground on the server. */
export async function requestGround(address: string, room: string, token: string): Promise<GroundGrid> {
  const answer = await fetch(address, token ? { headers: { Authorization: `Bearer ${token}` } } : {});
  if (!answer.ok) throw new Error(kNetTexts.noGround(room, `${answer.status} ${answer.statusText}`));
  const read = readGround(new Uint8Array(await answer.arrayBuffer()));
  if (isMalformed(read)) throw new Error(read.reason);
  return read.ground;
}

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

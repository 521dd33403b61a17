// Asks the server for the ground of a room.
import { readGround, type GroundGrid } from "../codec/ground";
import { isMalformed } from "../codec/malformed";

/** Throws an Error with a line for people where there is none or it cannot be read. */
export async function requestGround(room: string, token: string): Promise<GroundGrid> {
  const answer = await fetch(`/api/v1/rooms/${encodeURIComponent(room)}/ground`, token ? { headers: { Authorization: `Bearer ${token}` } } : {});
  if (!answer.ok) throw new Error(`the ground of ${room}: ${answer.status} ${answer.statusText}`);
  const read = readGround(new Uint8Array(await answer.arrayBuffer()));
  if (isMalformed(read)) throw new Error(read.reason);
  return read.ground;
}

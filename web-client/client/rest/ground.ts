// Asks the server for the ground of a room with a bed.
import { readGround, type GroundGrid } from "../codec/ground";
import { isMalformed } from "../codec/malformed";
import { kSessionTexts } from "../session/texts";

/** Throws an Error with a line for people if the room has no ground or it cannot be read. `address`: of the ground on the server. */
export async function requestGround(address: string, room: string, token: string): Promise<GroundGrid> {
  const answer = await fetch(address, token ? { headers: { Authorization: `Bearer ${token}` } } : {});
  if (!answer.ok) throw new Error(kSessionTexts.noGround(room, `${answer.status} ${answer.statusText}`));
  const read = readGround(new Uint8Array(await answer.arrayBuffer()));
  if (isMalformed(read)) throw new Error(read.reason);
  return read.ground;
}

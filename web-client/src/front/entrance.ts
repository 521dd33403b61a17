// Whether the page's address leads to the water of a room or to the front page with all rooms.
import { isEmbeddedAddress, isKioskAddress, isProjectorAddress } from "../app/address";
import { findMissingRoom, type Fetch } from "../../client/session/missing_room";
import { roomOf, wishOf } from "../net/room_address";
import type { RoomSummary } from "../../client/rest/rooms";

export interface EntranceWorld {
  requestRooms(token: string): Promise<readonly RoomSummary[]>;
  fetch: Fetch;
}

/** True for the front page: the server has several rooms and the address names none, or the named one does not exist. False also where the
 *  server cannot tell: the water's page then says what is wrong. */
export async function leadsToFront(search: string, socketUrl: string, token: string, world: EntranceWorld): Promise<boolean> {
  // Frames and projectors keep what they were given, and a scene in the address opens its room.
  if (isEmbeddedAddress({ search }) || isProjectorAddress({ search }) || wishOf(search)) return false;
  // A kiosk waits for its room.
  if (isKioskAddress({ search }) && roomOf(search)) return false;
  if (roomOf(search)) return (await findMissingRoom(socketUrl, token, world.fetch)) !== undefined;
  return world.requestRooms(token).then((rooms) => rooms.length > 1, () => false);
}

// Links to the rooms of the server, for a page whose room does not exist.
import { make } from "./dom";
import { kTexts } from "./texts";

/** Parameters that make sense with one room only. */
const kOfOneRoom = ["scene", "set", "view", "camera"];

/** `page`: the address, whose other choices the links keep. */
export function showRooms(list: HTMLElement, rooms: readonly string[], page: string): void {
  list.hidden = rooms.length === 0;
  list.replaceChildren(make("li", {}, [kTexts.roomsHere]), ...rooms.map((name) => make("li", {}, [make("a", { href: addressOfRoom(page, name) }, [name])])));
}

/** Returns the page's address for another room, with the other choices that the page's has. */
export function addressOfRoom(page: string, room: string): string {
  const url = new URL(page);
  for (const name of kOfOneRoom) url.searchParams.delete(name);
  url.searchParams.set("room", room);
  url.hash = "";
  return url.href;
}

// Links to the rooms of the server, for a page whose room does not exist.
import { make } from "./dom";
import { kTexts } from "./texts";

/** `page`: the address, whose other choices the links keep. */
export function showRooms(list: HTMLElement, rooms: readonly string[], page: string): void {
  list.hidden = rooms.length === 0;
  list.replaceChildren(make("li", {}, [kTexts.roomsHere]), ...rooms.map((name) => make("li", {}, [make("a", { href: addressOfRoom(page, name) }, [name])])));
}

function addressOfRoom(page: string, room: string): string {
  const url = new URL(page);
  for (const name of ["scene", "set"]) url.searchParams.delete(name);
  url.searchParams.set("room", room);
  return url.href;
}

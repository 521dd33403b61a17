// The way to the front page of a page whose room does not exist: it loads its address again, which then shows the rooms that there are
// (front/entrance.ts). The reason is kept for it in the tab, so that no link can put words on the page.
import { sessionStorageIfAny } from "../net/identity_store";
import { addressOfRoom } from "../ui/room_links";

const kReasonKey = "spindrift-missing-room";

/** Loads the page anew without what opens a room. */
export function leadToFront(room: string, reason: string): void {
  try {
    sessionStorageIfAny()?.setItem(kReasonKey, reason);
  } catch {
    // Full: the front page says which room is missing, not why.
  }
  location.replace(addressOfRoom(location.href, room));
}

/** Returns why the room was refused, once; undefined if it was not. */
export function takeRefusal(): string | undefined {
  const storage = sessionStorageIfAny();
  const reason = storage?.getItem(kReasonKey) ?? undefined;
  storage?.setItem(kReasonKey, "");
  return reason || undefined;
}

// Opens the room of a link by REST. Who may not open rooms gets the reason.
import type { Fetch } from "../../client/session/missing_room";
import type { RoomWish } from "../../client/rest/rooms";
import { kNetTexts } from "./net_texts";

const kForbidden = 403;
/** Somebody else opens the room at this moment, or a busy server takes longer than it lets a request wait. */
const kMaybeLater = [409, 504];
/** So often is then asked whether it is there: its shaders are compiled first, which takes seconds. */
const kAskCount = 120;
const kAskEveryMs = 1000;

/** Opens the room of this socket. Returns undefined when it exists, whoever opened it; otherwise why it does not and what to do, for people. */
export async function openRoom(socketUrl: string, token: string, { scene, parameters }: RoomWish, fetch: Fetch, wait: (ms: number) => Promise<void>): Promise<string | undefined> {
  const parts = /^ws(s?:.*\/)ws\/([^/?]+)$/.exec(socketUrl);
  if (!parts) return kNetTexts.unreadableName;
  const list = `http${parts[1]}api/v1/rooms`;
  const authorization: Record<string, string> = token ? { Authorization: `Bearer ${token}` } : {};
  const body = JSON.stringify({ name: decodeURIComponent(parts[2]!), scene, parameters });
  try {
    const opened = await fetch(list, { method: "POST", headers: { ...authorization, "Content-Type": "application/json" }, body });
    if (opened.ok) return undefined;
    const { message } = (await opened.json()) as { message?: string };
    for (let k = 0; kMaybeLater.includes(opened.status) && k < kAskCount; ++k) {
      if ((await fetch(`${list}/${parts[2]}`, { headers: authorization, cache: "no-store" })).ok) return undefined;
      await wait(kAskEveryMs);
    }
    const why = message || kNetTexts.answers(opened.status);
    return opened.status === kForbidden ? kNetTexts.notOperator(why) : why;
  } catch {
    return kNetTexts.serverSilent;
  }
}

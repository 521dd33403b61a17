// Why a WebSocket did not open: browsers hide the reply to a refused upgrade, so a client whose room may not exist asks REST.

/** The room of the address does not exist. */
export interface MissingRoom {
  name: string;
  /** The rooms that there are; never empty. */
  rooms: string[];
}

/** The part of fetch() that is used. */
export type Fetch = (url: string, init: RequestInit) => Promise<{ ok: boolean; status: number; json(): Promise<unknown> }>;

/**
 * Asks the server of this socket for its room. Returns undefined if the room exists, or if that cannot be told: the server does not
 * answer, or it lists no rooms, as an edge that has just started.
 */
export async function findMissingRoom(socketUrl: string, token: string, fetch: Fetch): Promise<MissingRoom | undefined> {
  const parts = /^ws(s?:.*\/)ws\/([^/?]+)(?:\?.*)?$/.exec(socketUrl);
  if (!parts) return undefined;
  const list = `http${parts[1]}api/v1/rooms`;
  const init: RequestInit = { headers: token ? { Authorization: `Bearer ${token}` } : {}, cache: "no-store" };
  try {
    const answer = await fetch(`${list}/${parts[2]}`, init);
    if (answer.status !== 404) return undefined;
    const listed = await fetch(list, init);
    if (!listed.ok) return undefined;
    const { rooms = [] } = (await listed.json()) as { rooms?: { name: string }[] };
    if (rooms.length === 0) return undefined;
    return { name: decodeURIComponent(parts[2]!), rooms: rooms.map(({ name }) => name) };
  } catch {
    return undefined;
  }
}

// Requests of a page that shares its room: what was changed in it, and a new room with a token for each role.
import type { RoleName } from "../codec/people";
import type { ParameterValue, RoomWish } from "./room_address";
import { kNetTexts } from "./net_texts";

export interface RoomWithTokens {
  room: string;
  tokens: Record<RoleName, string>;
}

/** A room of the server, as its list has it. */
export interface RoomSummary {
  name: string;
  scene: string;
  title: string;
  isPaused: boolean;
  isAsleep: boolean;
  /** People who are connected to it. */
  peopleCount: number;
}

const kRoles: readonly [RoleName, string][] = [["operator", "ROLE_OPERATOR"], ["player", "ROLE_PLAYER"], ["viewer", "ROLE_VIEWER"]];

/** Returns the parameters whose values differ from those of the room's scene. Throws an Error with a line for people. */
export async function requestChanges(room: string, token: string): Promise<ParameterValue[]> {
  const { parameters = [] } = (await ask(`api/v1/rooms/${encodeURIComponent(room)}/changes`, token)) as { parameters?: ParameterValue[] };
  return parameters.map(({ path, value }) => ({ path, value }));
}

/** Returns the rooms that this visitor may know of. Throws an Error with a line for people. */
export async function requestRooms(token: string): Promise<RoomSummary[]> {
  const { rooms = [] } = (await ask("api/v1/rooms", token)) as { rooms?: { name: string; scene?: string; title?: string; paused?: boolean; asleep?: boolean; people_count?: number }[] };
  return rooms.map(({ name, scene = "", title = "", paused = false, asleep = false, people_count: peopleCount = 0 }) => ({ name, scene, title: title || name, isPaused: paused, isAsleep: asleep, peopleCount }));
}

/** Returns the names of the scenes that a room can be opened with. Throws an Error with a line for people. */
export async function requestScenes(token: string): Promise<string[]> {
  const { scenes = [] } = (await ask("api/v1/scenes", token)) as { scenes?: string[] };
  return scenes;
}

/** Opens a room with tokens of its own. The server shows them once; they end with the room. Throws an Error with a line for people. */
export async function openRoomWithTokens(room: string, { scene, parameters }: RoomWish, token: string): Promise<RoomWithTokens> {
  const body = JSON.stringify({ name: room, scene, parameters, tokens: kRoles.map(([, wire]) => wire) });
  const opened = (await ask("api/v1/rooms", token, { method: "POST", body, headers: { "Content-Type": "application/json" } })) as { tokens?: { token: string }[] };
  const tokens = Object.fromEntries(kRoles.map(([role], k) => [role, opened.tokens?.[k]?.token ?? ""])) as Record<RoleName, string>;
  return { room, tokens };
}

/** Asks the REST API; `url` is relative to the page. Throws an Error with a line for people. */
export async function ask(url: string, token: string, init: RequestInit & { headers?: Record<string, string> } = {}): Promise<unknown> {
  const answer = await fetch(url, { ...init, cache: "no-store", headers: { ...init.headers, ...(token ? { Authorization: `Bearer ${token}` } : {}) } });
  const body: unknown = await answer.json().catch(() => ({}));
  if (!answer.ok) throw new Error((body as { message?: string }).message ?? kNetTexts.answers(answer.status));
  return body;
}

// Requests about rooms. `base`: address of the server with a slash at its end; empty in a page of the server.
import type { RoleName } from "../codec/people";
import { kSessionTexts } from "../session/texts";

/** What a room is opened with. */
export interface RoomWish {
  scene: string;
  parameters: ParameterValue[];
}

export interface ParameterValue {
  path: string;
  value: number;
}

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
export async function requestRooms(token: string, base = ""): Promise<RoomSummary[]> {
  const { rooms = [] } = (await ask(`${base}api/v1/rooms`, token)) as { rooms?: { name: string; scene?: string; title?: string; paused?: boolean; asleep?: boolean; people_count?: number }[] };
  return rooms.map(({ name, scene = "", title = "", paused = false, asleep = false, people_count: peopleCount = 0 }) => ({ name, scene, title: title || name, isPaused: paused, isAsleep: asleep, peopleCount }));
}

/** Returns the names of the scenes that a room can be opened with. Throws an Error with a line for people. */
export async function requestScenes(token: string, base = ""): Promise<string[]> {
  const { scenes = [] } = (await ask(`${base}api/v1/scenes`, token)) as { scenes?: string[] };
  return scenes;
}

/** Opens a room with tokens of its own. The server shows them once; they end with the room. Throws an Error with a line for people. */
export async function openRoomWithTokens(room: string, { scene, parameters }: RoomWish, token: string, base = ""): Promise<RoomWithTokens> {
  const body = JSON.stringify({ name: room, scene, parameters, tokens: kRoles.map(([, wire]) => wire) });
  const opened = (await ask(`${base}api/v1/rooms`, token, { method: "POST", body, headers: { "Content-Type": "application/json" } })) as { tokens?: { token: string }[] };
  const tokens = Object.fromEntries(kRoles.map(([role], k) => [role, opened.tokens?.[k]?.token ?? ""])) as Record<RoleName, string>;
  return { room, tokens };
}

/** Asks the REST API. Throws an Error with a line for people. */
export async function ask(url: string, token: string, init: RequestInit & { headers?: Record<string, string> } = {}): Promise<unknown> {
  const answer = await fetch(url, { ...init, cache: "no-store", headers: { ...init.headers, ...(token ? { Authorization: `Bearer ${token}` } : {}) } });
  const body: unknown = await answer.json().catch(() => ({}));
  if (!answer.ok) throw new Error((body as { message?: string }).message ?? kSessionTexts.answers(answer.status));
  return body;
}

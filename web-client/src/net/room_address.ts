// Which room a page's address means:
//   ?room=NAME               that room; without it, the server's first one
//   ?scene=SCENE             the room of that scene, which is opened if it does not exist
//   ?room=NAME&scene=SCENE   the room NAME, which is opened with that scene if it does not exist
//   &set=PATH:VALUE,…        values of the scene's parameters in a room that is opened; without effect on a room that exists
// Everybody who opens the same link comes into the same room, so its name follows from scene and values alone.
import type { ParameterValue, RoomWish } from "../../client/rest/rooms";

/** As in the server: letters, digits, "_" and "-". */
const kRoomNameMaxLength = 32;
const kParametersMaxCount = 64;

/** Returns the name of the room; empty for the server's first one. */
export function roomOf(search: string): string {
  const parameters = new URLSearchParams(search);
  const room = parameters.get("room");
  const wish = wishOf(search);
  if (room || !wish) return room ?? "";
  const values = textOfValues(wish.parameters);
  const suffix = values === "" ? "" : `-${hashOf(values)}`;
  return wish.scene.replace(/[^A-Za-z0-9_-]/g, "-").slice(0, kRoomNameMaxLength - suffix.length) + suffix;
}

/** Undefined: a room that does not exist stays closed. */
export function wishOf(search: string): RoomWish | undefined {
  const parameters = new URLSearchParams(search);
  const scene = parameters.get("scene");
  return scene ? { scene, parameters: readValues(parameters.get("set") ?? "") } : undefined;
}

/** Returns the value of `set`, sorted by path. */
export function textOfValues(values: readonly ParameterValue[]): string {
  return [...values].sort((a, b) => (a.path < b.path ? -1 : 1)).map(({ path, value }) => `${path}:${value}`).join(",");
}

/** Leaves out what is not a path and a number. */
function readValues(text: string): ParameterValue[] {
  return text.split(",", kParametersMaxCount).flatMap((part) => {
    const [, path, value] = /^([a-z0-9_.]+):([-+0-9.eE]+)$/.exec(part) ?? [];
    return path !== undefined && Number.isFinite(Number(value)) ? [{ path, value: Number(value) }] : [];
  });
}

/** FNV-1a of the text's characters, 32 bits, as 8 hexadecimal digits. */
function hashOf(text: string): string {
  let hash = 0x811c9dc5;
  for (let k = 0; k < text.length; ++k) hash = Math.imul(hash ^ text.charCodeAt(k), 0x01000193);
  return (hash >>> 0).toString(16).padStart(8, "0");
}

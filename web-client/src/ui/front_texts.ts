// Texts of the front page: English. texts_de.ts has the German ones.
import { translation } from "../net/translation";
import type { Row } from "./texts";

const kEnglish = {
  lead: "Choose a water.",
  rooms: "Rooms of this server",
  noSuchRoom: (name: string) => `There is no room ${name}. These are the rooms of this server.`,
  refusedRoom: (why: string) => `${why[0]!.toUpperCase()}${why.slice(1)}.`,
  listFailed: (why: string) => `The list of rooms is not up to date (${why}). It is asked for again every few seconds.`,
  noRooms: "This server has no room that you may enter. One may be opened at any time; this page shows it then.",
  open: "Open",
  openRoom: "Open a room",
  openRoomWhy: "A room of the scene; everybody with its link comes into the same one.",
  openScene: { label: "Scene", help: "The scene of the room that is opened." } as Row,
  sceneOfRoom: (scene: string, room: string) => (scene === room ? scene : `${scene} · room ${room}`),
  peopleCount: (count: number) => (count === 0 ? "nobody in it" : count === 1 ? "1 person" : `${count} people`),
  roomState: { running: "running", paused: "paused", asleep: "asleep until somebody enters" },
};

export type FrontTexts = typeof kEnglish;

/** In the language that was loaded before. */
export const kFrontTexts: FrontTexts = { ...kEnglish, ...translation.front };

// Texts of the page for people, in one table, so that a translation replaces this file.
import type { SideWhat, SideWhere } from "./side_names";

const kSides: Record<SideWhat, string> = { beach: "beach", sea: "open sea", rocks: "rocky shore", quay: "quay", wall: "wall", end: "open end" };

export const kTexts = {
  // The card
  paused: "paused",

  // What others did, as a line over the water
  somebody: "Somebody",
  pausedBy: (name: string) => `${name} paused the water.`,
  resumedBy: (name: string) => `${name} lets the water run again.`,
  speedBy: (name: string, speed: number) => `${name} set the speed to ${speed} ×.`,
  startedAgainBy: (name: string) => `${name} started the scene again.`,
  otherScene: (title: string) => `The scene is now ${title}.`,

  // What the server does by itself
  restarts: "The server restarts; this page connects again by itself.",
  moves: "The water moves to another server; this page follows by itself.",

  // What failed
  notNow: "The lesson does not allow this at present.",
  failed: (what: string, why: string) => `${what}: ${why}`,

  gaugesNotLoaded: "The gauges' names and chart could not be loaded; reload the page.",

  // The hint of the first visit
  movesObjectsByMouse: "Drag an object to move it; the wheel turns it.",
  movesObjectsByTouch: "Drag an object to move it; a second finger turns it.",

  // Picture, film, fullscreen
  actions: "Picture, sound and link",
  share: "Share a link to what you see, also as a QR code",
  fullscreen: "Fullscreen",
  leaveFullscreen: "Leave fullscreen",
  picture: "Save a picture",
  film: (longestS: number) => `Film the water (at most ${longestS} s)`,
  endFilm: "End the film and save it",
  fullscreenFailed: (why: string) => `Fullscreen was refused by the browser (${why}).`,
  pictureFailed: (why: string) => `The picture was not saved (${why}); try again.`,
  filmNeedsHttps: "Browsers encode films only on pages opened by https:// or from this machine.",
  filmHasNoCodec: "This browser encodes neither H.264, VP9 nor VP8; try a current Chrome, Edge, Firefox or Safari.",
  filmFailed: (why: string) => `The film was not saved (${why}); try again.`,

  // The front page
  frontLead: "Choose a water.",
  frontRooms: "Rooms of this server",
  noSuchRoom: (name: string) => `There is no room ${name}. These are the rooms of this server.`,
  refusedRoom: (why: string) => `${why[0]!.toUpperCase()}${why.slice(1)}.`,
  listFailed: (why: string) => `The list of rooms is not up to date (${why}). It is asked for again every few seconds.`,
  tryNow: "Try now",
  noAnswer: "the server does not answer",
  noRooms: "This server has no room that you may enter. One may be opened at any time; this page shows it then.",
  open: "Open",
  openRoom: "Open a room",
  openRoomWhy: "A room of the scene; everybody with its link comes into the same one.",
  scene: "Scene",
  sceneOfRoom: (scene: string, room: string) => (scene === room ? scene : `${scene} · room ${room}`),
  peopleCount: (count: number) => (count === 0 ? "nobody in it" : count === 1 ? "1 person" : `${count} people`),
  roomState: { running: "running", paused: "paused", asleep: "asleep until somebody enters" },

  // A kiosk
  kioskInvite: "Touch the water",
  kioskCountdown: (leftS: number) => `Back to the start in ${leftS} s – touch to continue`,
  kioskBoat: "To my boat",
  kioskWhole: "Whole water",
  kioskPutAway: "Putting away",

  // Sides of the water
  /** `where`: as seen from the first view; undefined for the only side of its kind. */
  side: (what: SideWhat, where: SideWhere | undefined) => (where ? `${where} side: ${kSides[what]}` : kSides[what]),
  openSide: "the open side",
  direction: "a direction",
};

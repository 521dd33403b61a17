// Part of the table of texts (texts.ts): gauges, the front page and kiosks.
import { fixed } from "./numbers";

/** A row of the panel: its label, and what it does, as a tooltip. */
export interface Row {
  label: string;
  help: string;
}

export const kVisitTexts = {
  // Gauges
  gauges: {
    gauges: "Gauges",
    open: "What the gauges in the water measure, as a chart",
    elevation: "Elevation",
    velocityX: "Velocity along x",
    velocityZ: "Velocity along z",
    shows: { label: "Shows", help: "Elevation over the still water, or the velocity of the flow as a mean over the depth." } as Row,
    span: { label: "Last", help: "The time that the chart shows. The page keeps at most the last 4,800 readings." } as Row,
    pause: "Pause",
    pauseHelp: "Holds the chart; the water runs on.",
    resume: "Continue",
    csv: "CSV",
    csvHelp: "Saves the readings of the chosen gauges as a table.",
    picture: "PNG",
    pictureHelp: "Saves the chart as a picture.",
    close: "Close",
    at: (timeS: number) => `at ${fixed(timeS, 2)} s`,
    newest: "now",
    time: "Time since the start [s]",
    noReadings: "No readings yet.",
    none: "Choose a gauge below.",
    empty: "There is no gauge in this water yet.",
    place: "Place a gauge",
    placeHelp: "Puts a gauge of your own into the water with the next tap on it, for everybody to see; at most 4.",
    placing: "Cancel",
    placeByTouch: "Tap the water where the gauge is to stand.",
    placeByMouse: "Click the water where the gauge is to stand, or choose the place with the arrow keys and press Enter. Escape cancels.",
    remove: (gauge: string) => `Remove the gauge ${gauge}`,
    ownGauge: "Placed by you",
    gaugeOf: (person: string) => `Placed by ${person}`,
    notLoaded: "The chart could not be loaded: try again when the server can be reached.",
    noHistory: (gauge: string, why: string) => `The history of the gauge ${gauge} could not be read: ${why}`,
    noPicture: "the canvas gives none",
    pictureFailed: (why: string) => `The picture of the chart was not saved (${why}); try again.`,
  },

  // The front page
  frontLead: "Choose a water.",
  frontRooms: "Rooms of this server",
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

  // A kiosk
  kioskInvite: "Touch the water",
  kioskCountdown: (leftS: number) => `Back to the start in ${leftS} s – touch to continue`,
  kioskBoat: "To my boat",
  kioskWhole: "Whole water",
  kioskPutAway: "Putting away",
};

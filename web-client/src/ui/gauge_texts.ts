// Texts of gauges, their chart and its files: English. texts_de.ts has the German ones.
import { translation } from "../net/translation";
import { fixed } from "./numbers";
import type { Row } from "./texts";

const kEnglish = {
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
};

export type GaugeTexts = typeof kEnglish;

/** In the language that was loaded before. */
export const kGaugeTexts: GaugeTexts = { ...kEnglish, ...translation.gauge };

// Texts of a class: the operator's controls of a lesson, and the projector: English. texts_de.ts has the German ones.
import type { TeamName } from "../../client/codec/people";
import { translation } from "../net/translation";
import type { Row } from "./texts";

const kEnglish = {
  title: "Class", pausePads: "Pause pads", resumePads: "Resume pads", teams: "Teams", clear: "Take out all objects", endGame: "End the game",
  noGames: "This scene has no course for a race and no goals; the scene “regatta” has both.", whoPlays: "Who plays", nobody: "Nobody plays yet.",
  force: { label: "Force", help: "Share of what a pupil's tool does to the water." } as Row,
  laps: { label: "Laps", help: "Laps of a race." } as Row,
  goals: { label: "Goals to win", help: "Goals that win." } as Row,
  startRace: "Start a race", startBall: "Start a ball game", reset: "Start the scene again", really: "Really? Press again",
  toolsGroup: "Tools handed out", gameGroup: "Game", waterGroup: "Water", peopleGroup: "People",
  teamOf: (name: string, team: TeamName | undefined) => `Team of ${name}: ${team ?? "none"}`,
  mute: "Mute", unmute: "Unmute", muteName: (name: string) => `Mute ${name}`, unmuteName: (name: string) => `Unmute ${name}`,

  // The projector
  padsPaused: "Pads are paused",
  andMore: (count: number) => `and ${count} more`,
  phonesCannotJoin: "Phones cannot reach this server: it listens on this machine only, or has no network. Start it with --class, or give its address with --public-url",
  joinTip: "Larger or smaller; with several addresses, the next one",
  padQr: "QR code of the pad's address",
  scanOrOpen: "Scan, or open",
  addressOf: (number: number, count: number) => `address ${number} of ${count}`,
};

export type ClassTexts = typeof kEnglish;

/** In the language that was loaded before. */
export const kClassTexts: ClassTexts = { ...kEnglish, ...translation.class };

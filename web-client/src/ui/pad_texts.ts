// Texts of pads: English. texts_de.ts has the German ones.
import type { LessonTool } from "../../client/codec/lesson";
import { translation } from "../net/translation";

const kEnglish = {
  water: "The water from above. Touch it with the chosen tool; with keys, the arrows move a cursor and Enter uses the tool.", speed: "Speed", heading: "Heading", launch: "Launch my boat", takeOut: "Take out",
  takeOutLabel: "Take my boat out of the water", tools: "Tools", useName: "Use this name",
  stick: "Helm: push up for ahead, down for astern, sideways to steer; arrow keys do the same",
  lost: "The connection was lost. The pad comes back by itself.", connecting: "Connecting to the water…", restarts: "The server restarts; the pad comes back by itself.",
  mayWatch: "You may watch here. Ask the teacher for a link to play.",
  does: {
    finger: "Draw in the water with your fingers.", splash: "Tap for a splash; hold for a larger one.", wave: "Drag to send a wave that way.", rain: "Drag a rain cloud; tap to leave one behind.",
    float: "Tap to drop an object; drag one to move it.", throw: "Flick to throw a stone; tap to toss one.", boat: "Push the stick ahead and steer.",
  } as Record<LessonTool, string>,
  /** Names for people who have not said theirs: one of each list. */
  nameKinds: ["Merry", "Brave", "Swift", "Sunny", "Clever", "Lucky", "Bold", "Gentle", "Nimble", "Jolly", "Calm", "Bright"],
  nameAnimals: ["Otter", "Seal", "Gull", "Puffin", "Dolphin", "Heron", "Crab", "Turtle", "Osprey", "Penguin", "Walrus", "Marlin", "Tern", "Squid", "Orca", "Pelican"],
};

export type PadTexts = typeof kEnglish;

/** In the language that was loaded before. */
export const kPadTexts: PadTexts = { ...kEnglish, ...translation.pad };

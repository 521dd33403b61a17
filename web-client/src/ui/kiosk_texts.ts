// Texts of a kiosk: English. texts_de.ts has the German ones.
import { translation } from "../net/translation";

const kEnglish = {
  invite: "Touch the water",
  countdown: (leftS: number) => `Back to the start in ${leftS} s – touch to continue`,
  boat: "To my boat",
  whole: "Whole water",
  putAway: "Putting away",
};

export type KioskTexts = typeof kEnglish;

/** In the language that was loaded before. */
export const kKioskTexts: KioskTexts = { ...kEnglish, ...translation.kiosk };

// Texts of the card of keys: English. texts_de.ts has the German ones.
import { translation } from "../net/translation";

const kEnglish = {
  title: "Keys", close: "Close",
  rows: [
    ["Tab", "to the next control; to the water and out of it"],
    ["← → ↑ ↓", "on the water: move the cursor; in the boat view: steer"],
    ["Enter", "on the water: use the tool at the mouse or the cursor; held, with the arrows: draw, throw, move an object"],
    ["1 … 7", "choose a tool"],
    ["Q, E", "turn the object that is held"],
    ["Del", "take out the object that is held or pointed at"],
    [", .", "choose what the tool Float drops"],
    ["Shift + ← → ↑ ↓", "turn the view"],
    ["+ −", "bring it nearer, farther"],
    ["V", "next view"],
    ["B", "new boat"],
    ["P", "pause and resume (operators)"],
    ["N", "one step while it is paused (operators)"],
    ["M", "sound on and off"],
    ["C", "show and hide the controls"],
    ["?", "this list"],
  ] as [keys: string, does: string][],
};

export type KeysTexts = typeof kEnglish;

/** In the language that was loaded before. */
export const kKeysTexts: KeysTexts = { ...kEnglish, ...translation.keys };

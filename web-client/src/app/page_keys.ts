// Keys that work everywhere on the page, but in text fields, lists and sliders. docs/controls.md and the card of keys list all.
import { byId, isTyping } from "../ui/dom";
import { kTexts } from "../ui/texts";
import type { App } from "./app";
import { lateCard } from "./late_card";

/** Turn of what is held, and zoom of the view, per press. */
const kTurnRad = 0.2;
const kZoom = 1.15;

/** Presses a button as the mouse would, if it is there and enabled. */
function press(id: string): void {
  const button = byId<HTMLButtonElement>(id);
  if (button.checkVisibility()) button.click();
}

export function connectPageKeys(app: App): void {
  const help = lateCard(() => import("../ui/keys_card").then(({ KeysCard }) => new KeysCard()), () => app.warn(kTexts.shareFailed));
  const zoom = (by: number): void => app.display.views.orbit(0, 0, by);
  /** By the letter or sign, in lower case. True: while a key is held, too. */
  const keys: Record<string, [run: () => void, repeats?: true]> = {
    "delete": [() => app.removePointed()],
    "q": [() => app.turnHeld(-kTurnRad), true],
    "e": [() => app.turnHeld(kTurnRad), true],
    ",": [() => app.floaterRows.step(-1), true],
    ".": [() => app.floaterRows.step(1), true],
    "+": [() => zoom(1 / kZoom), true],
    "=": [() => zoom(1 / kZoom), true],
    "-": [() => zoom(kZoom), true],
    "p": [() => app.role === "operator" && byId("pause").click()],
    "n": [() => app.role === "operator" && byId("step").click(), true],
    "v": [() => app.viewButtons.step()],
    "b": [() => byId("spawn").click()],
    "c": [() => press("panel-toggle")],
    "?": [help],
  };
  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || isTyping(event.target)) return;
    const [run, repeats] = keys[event.key.toLowerCase()] ?? [];
    if (!event.repeat || repeats) run?.();
  });
  byId("keys-button").addEventListener("click", help);
}

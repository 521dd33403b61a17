// Chooses the look of the water.
import type { LookName } from "../scene/looks/looks";
import { byId, make, setText } from "./dom";
import { SelectRow } from "./select_row";
import { kTexts } from "./texts";

export class LookRow {
  private readonly row: SelectRow;
  private readonly help = make("p", { class: "hint", "data-testid": "look-help" });

  constructor(chosen: (look: LookName) => void) {
    this.row = new SelectRow("look", kTexts.look, (value) => chosen(value as LookName));
    byId("look-row").append(this.row.element, this.help);
  }

  /** `looks`: those that this room has data for. */
  show(looks: readonly LookName[], shown: LookName): void {
    this.row.setChoices(looks.map((name) => ({ value: name, label: kTexts.looks[name].label })), shown);
    setText(this.help, kTexts.looks[shown].help);
    this.help.hidden = shown === "natural";
  }
}

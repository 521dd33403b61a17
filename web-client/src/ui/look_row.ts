// Chooses the look of the water.
import { kLooks, type LookName } from "../scene/looks/looks";
import { byId, make, setText } from "./dom";
import { SelectRow } from "./select_row";

export class LookRow {
  private readonly row: SelectRow;
  private readonly help = make("p", { class: "hint", "data-testid": "look-help" });

  constructor(chosen: (look: LookName) => void) {
    this.row = new SelectRow("look", "Look", "What the water shows, on this page only: its natural look, or data in colours.", (value) => chosen(value as LookName));
    byId("look-row").append(this.row.element, this.help);
  }

  /** `looks`: those that this room has data for. */
  show(looks: readonly LookName[], shown: LookName): void {
    this.row.setChoices(looks.map((name) => ({ value: name, label: kLooks[name].label })), shown);
    setText(this.help, kLooks[shown].help);
    this.help.hidden = shown === "natural";
  }
}

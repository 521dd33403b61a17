// What a drag on the water does: draw, or turn the view.
import { byId } from "./dom";
import { keepChoice, keptChoice } from "./kept";
import { SelectRow } from "./select_row";

const kDragKey = "drag";

export class DrawingRow {
  private readonly row = new SelectRow("drag", "Drag", "What a drag on the water does. The right button, or two fingers, turn the view where a drag draws.", (value) => keepChoice(kDragKey, value));

  constructor() {
    const choices = [
      { value: "draw", label: "uses the tool" },
      { value: "turn", label: "turns the view" },
    ];
    this.row.setChoices(choices, keptChoice(kDragKey) === "turn" ? "turn" : "draw");
    byId("drag-row").append(this.row.element);
  }

  /** True: a drag with the first button or a finger uses the tool. False: it turns the view, and the right button uses the tool. */
  get drawsFirst(): boolean {
    return this.row.value === "draw";
  }

  /** `mayDraw`: there is water that this visitor may change. */
  setAllowed(mayDraw: boolean): void {
    this.row.element.hidden = !mayDraw;
  }

  /** How the view is turned, as a sentence; empty where a drag turns it. */
  describeTurning(): string {
    if (!this.drawsFirst) return "";
    return window.matchMedia("(pointer: coarse)").matches ? "Two fingers turn the view." : "The right button turns the view.";
  }
}

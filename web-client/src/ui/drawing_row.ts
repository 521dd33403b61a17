// What a drag on the water does: draw, or turn the view.
import { byId } from "./dom";
import { keepChoice, keptChoice } from "./kept";
import { SelectRow } from "./select_row";
import { kTexts } from "./texts";

const kDragKey = "drag";

export class DrawingRow {
  private readonly row = new SelectRow("drag", kTexts.drag, (value) => keepChoice(kDragKey, value));

  constructor() {
    const choices = [
      { value: "draw", label: kTexts.drags.draw },
      { value: "turn", label: kTexts.drags.turn },
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
    return window.matchMedia("(pointer: coarse)").matches ? kTexts.turnsByTouch : kTexts.turnsByMouse;
  }
}

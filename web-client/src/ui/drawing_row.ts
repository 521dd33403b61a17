// What a drag on the water does, and the line that tells a first visitor.
import { byId, setText } from "./dom";
import { keepChoice, keptChoice } from "./kept";
import { SelectRow } from "./select_row";

const kDragKey = "drag";
const kHintKey = "has-drawn";
const kHintS = 12;

export class DrawingRow {
  private readonly row = new SelectRow("drag", "Drag", "What a drag on the water does. The right button, or two fingers, turn the view where a drag draws.", (value) => this.choose(value));
  private readonly hint = byId("hint");
  private isHinted = false;

  constructor() {
    const choices = [
      { value: "draw", label: "draws in the water" },
      { value: "turn", label: "turns the view" },
    ];
    this.row.setChoices(choices, keptChoice(kDragKey) === "turn" ? "turn" : "draw");
    byId("drag-row").append(this.row.element);
  }

  /** True: a drag with the first button or a finger draws. False: it turns the view, and the right button draws. */
  get drawsFirst(): boolean {
    return this.row.value === "draw";
  }

  /** `mayDraw`: there is water that this visitor may draw in. */
  setAllowed(mayDraw: boolean): void {
    this.row.element.hidden = !mayDraw;
    if (mayDraw && this.drawsFirst) this.showHint();
    else this.hint.hidden = true;
  }

  hasDrawn(): void {
    this.hint.hidden = true;
    keepChoice(kHintKey, "1");
  }

  private choose(value: string): void {
    keepChoice(kDragKey, value);
    this.hint.hidden = true;
  }

  /** On the first visit, for a while. */
  private showHint(): void {
    if (this.isHinted || keptChoice(kHintKey) !== undefined) return;
    this.isHinted = true;
    const turns = window.matchMedia("(pointer: coarse)").matches ? "two fingers turn the view" : "the right button turns the view";
    setText(this.hint, `Drag on the water to draw in it; ${turns}.`);
    this.hint.hidden = false;
    window.setTimeout(() => (this.hint.hidden = true), 1000 * kHintS);
  }
}

// The kinds of objects that the tool Float drops, beside the tools; in the panel, folded, their density and what removes all of them.
import type { CommandAction } from "../../client/session/events";
import { kFloaterKinds, type FloaterKindName } from "../../client/codec/floaters";
import { make } from "./dom";
import { densityName } from "./floater_tools";
import { keepChoice, keptChoice } from "./kept";
import { SliderRow } from "./slider_row";
import { kTexts } from "./texts";

const kKindKey = "object";
const kDensityRange = { ...kTexts.density, unit: "", min: 0, max: 3, step: 0.01, describe: (ratio: number) => (ratio > 0 ? kTexts.densityAs(ratio, densityName(ratio)) : densityName(ratio)) };

export class FloaterRows {
  /** Over the water's; 0: what suits the kind. */
  densityRatio = 0;
  kind: FloaterKindName = "crate";
  private readonly buttons = new Map<FloaterKindName, HTMLButtonElement>();
  private readonly removeAll = make("button", { type: "button", "data-testid": "remove-objects", title: kTexts.removeObjectsTip }, [kTexts.removeObjects]);
  private readonly folded: HTMLElement;

  /** `bar`: where the kinds go; `rows`: where the rest goes. */
  constructor(
    private readonly bar: HTMLElement,
    rows: HTMLElement,
    send: (action: CommandAction, label: string) => number,
  ) {
    for (const kind of kFloaterKinds) {
      const button = make("button", { type: "button", "data-testid": `object-${kind}`, title: kTexts.kindTip, class: "glass" }, [kTexts.kinds[kind]]);
      button.addEventListener("click", () => this.choose(kind));
      this.buttons.set(kind, button);
      bar.append(button);
    }
    const density = new SliderRow("object-density", kDensityRange, 0, (ratio) => (this.densityRatio = ratio));
    this.removeAll.addEventListener("click", () => send({ case: "removeFloater", value: { all: true } }, kTexts.commands.removeObjects));
    this.folded = make("details", { "data-testid": "object-rows" }, [make("summary", {}, [kTexts.objects]), density.element, this.removeAll]);
    rows.append(this.folded);
    const kept = keptChoice(kKindKey);
    this.choose(kFloaterKinds.find((kind) => kind === kept) ?? "crate");
    this.setAllowed(false, false);
  }

  /** `isOpen`: the tool that drops objects is chosen. */
  show(isOpen: boolean): void {
    this.bar.hidden = !isOpen;
    document.body.classList.toggle("kinds-open", isOpen);
  }

  /** `mayUse`: there are objects, and this visitor may drop some. */
  setAllowed(mayUse: boolean, isOperator: boolean): void {
    this.folded.hidden = !mayUse;
    this.removeAll.hidden = !isOperator;
  }

  /** Chooses a kind so many places further in the row; false while the row is not shown. */
  step(count: number): boolean {
    if (this.bar.hidden) return false;
    const length = kFloaterKinds.length;
    this.choose(kFloaterKinds[(kFloaterKinds.indexOf(this.kind) + count + length) % length]!);
    return true;
  }

  private choose(kind: FloaterKindName): void {
    this.kind = kind;
    keepChoice(kKindKey, kind);
    for (const [each, button] of this.buttons) button.setAttribute("aria-pressed", String(each === kind));
  }
}

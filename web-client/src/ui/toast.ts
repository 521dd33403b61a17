// One line about the result of a command, shown for a few seconds.
import { setText } from "./dom";

const kShownMs = 4000;
const kShownLongMs = 8000;

export class Toast {
  private timer: number | undefined;

  /** `showsGood`: results that are as wanted, too. */
  constructor(
    private readonly element: HTMLElement,
    private readonly showsGood: boolean,
  ) {}

  show(text: string, tone: "good" | "warn" | "bad"): void {
    if (tone === "good" && !this.showsGood) return;
    setText(this.element, text);
    this.element.dataset["tone"] = tone;
    this.element.classList.add("shown");
    if (this.timer !== undefined) window.clearTimeout(this.timer);
    // The text stays in the document for screen readers; only its display fades.
    this.timer = window.setTimeout(() => this.element.classList.remove("shown"), tone === "good" ? kShownMs : kShownLongMs);
  }
}

// The row of buttons beside the panel for what one does with the picture: fullscreen, a picture, a film. index.html has those for panel and
// sound; another button is one call of add().
import { byId, make, makeIcon, setText } from "./dom";
import { kTexts } from "./texts";

/** One stroke each, in a square of 24. */
const kIcons = {
  fullscreen: "M4 9V4h5M20 9V4h-5M4 15v5h5M20 15v5h-5",
  picture: "M4 8h3.5l1.5-2.5h6L16.5 8H20v11H4zM12 10a3.2 3.2 0 1 0 .01 0",
  share: "M3.6 12a2.4 2.4 0 1 0 4.8 0a2.4 2.4 0 1 0-4.8 0M15.1 5.5a2.4 2.4 0 1 0 4.8 0a2.4 2.4 0 1 0-4.8 0M15.1 18.5a2.4 2.4 0 1 0 4.8 0a2.4 2.4 0 1 0-4.8 0M8.2 10.8l7-4M8.2 13.2l7 4",
  film: "M3.5 6.5h11v11h-11zM14.5 10.5l6-3.5v10l-6-3.5",
};

export class PageActions {
  private readonly row = byId("actions");

  constructor() {
    this.row.setAttribute("aria-label", kTexts.actions);
  }

  /** Appends a button with an icon; `label` is its name for screen readers and its tooltip. */
  add(testId: string, icon: keyof typeof kIcons, label: string, pressed: () => void): ActionButton {
    const button = new ActionButton(testId, kIcons[icon], label);
    button.element.addEventListener("click", pressed);
    this.row.append(button.element);
    return button;
  }
}

export class ActionButton {
  readonly element: HTMLButtonElement;
  private readonly note = make("span", { class: "action-note" });

  constructor(testId: string, path: string, label: string) {
    this.element = make("button", { type: "button", class: "glass", "data-testid": testId }, [makeIcon(path), this.note]);
    this.show(label, false);
  }

  /** `isOn`: what the button began is under way; `note` stands in place of the icon then. */
  show(label: string, isOn: boolean, note = ""): void {
    this.element.setAttribute("aria-label", label);
    this.element.title = label;
    this.element.setAttribute("aria-pressed", String(isOn));
    setText(this.note, note);
  }
}

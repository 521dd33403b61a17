// The card that lists the keys. Loaded when it is asked for.
import { make } from "./dom";
import { kTexts } from "./texts";

const kCard = kTexts.keysCard;

export class KeysCard {
  private readonly closeButton = make("button", { type: "button", "data-testid": "keys-close" }, [kCard.close]);
  private readonly dialog = make("dialog", { class: "keys-card", "data-testid": "keys-card", "aria-label": kCard.title }, [
    make("div", {}, [
      make("h2", {}, [kCard.title]),
      make("dl", {}, kCard.rows.map(([keys, does]) => make("div", {}, [make("dt", {}, [make("kbd", {}, [keys])]), make("dd", {}, [does])]))),
      this.closeButton,
    ]),
  ]);

  constructor() {
    this.closeButton.addEventListener("click", () => this.dialog.close());
    this.dialog.addEventListener("click", ({ target }) => target === this.dialog && this.dialog.close());
    // The page's own keys choose tools.
    this.dialog.addEventListener("keydown", (event) => event.stopPropagation());
    document.body.append(this.dialog);
  }

  open(): void {
    this.dialog.showModal();
    this.closeButton.focus();
  }
}

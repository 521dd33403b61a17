// The card that lists the keys. Loaded when it is asked for.
import { makeCard } from "./card";
import { make } from "./dom";
import { kTexts } from "./texts";

const kCard = kTexts.keysCard;

export class KeysCard {
  private readonly closeButton = make("button", { type: "button", "data-testid": "keys-close" }, [kCard.close]);
  private readonly dialog = makeCard("keys-card", kCard.title, [
    make("div", {}, [
      make("h2", {}, [kCard.title]),
      make("dl", {}, kCard.rows.map(([keys, does]) => make("div", {}, [make("dt", {}, [make("kbd", {}, [keys])]), make("dd", {}, [does])]))),
      this.closeButton,
    ]),
  ], this.closeButton);

  open(): void {
    this.dialog.showModal();
    this.closeButton.focus();
  }
}

// The card that lists the keys. Loaded when it is asked for.
import { makeCard } from "./card";
import { make } from "./dom";
import { kKeysTexts } from "./keys_texts";


export class KeysCard {
  private readonly closeButton = make("button", { type: "button", "data-testid": "keys-close" }, [kKeysTexts.close]);
  private readonly dialog = makeCard("keys-card", kKeysTexts.title, [
    make("div", {}, [
      make("h2", {}, [kKeysTexts.title]),
      make("dl", {}, kKeysTexts.rows.map(([keys, does]) => make("div", {}, [make("dt", {}, [make("kbd", {}, [keys])]), make("dd", {}, [does])]))),
      this.closeButton,
    ]),
  ], this.closeButton);

  open(): void {
    this.dialog.showModal();
    this.closeButton.focus();
  }
}

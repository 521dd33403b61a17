// The button "Embed" and its card: the code that shows this view of the water in another page.
import { make, setText } from "./dom";
import { embedCode } from "./embed_code";

const kNote = "The server shows its water only in pages that it lists: start it with --embed and the origin of your page, such as https://school.example.";

/** `address`: returns the page's address with all that was chosen up to now. */
export function makeEmbedButton(address: () => string): HTMLButtonElement {
  const button = make("button", { id: "embed", type: "button", "data-testid": "embed", "aria-haspopup": "dialog", title: "Code that shows this view in a page of yours" }, ["Embed"]);
  let card: EmbedCard | undefined;
  button.addEventListener("click", () => {
    card ??= new EmbedCard();
    card.open(embedCode(address()));
  });
  return button;
}

class EmbedCard {
  private readonly code = make("textarea", { "data-testid": "embed-code", readonly: "", rows: "8", spellcheck: "false", "aria-label": "Code" });
  private readonly note = make("p", { class: "hint", "data-testid": "embed-note", role: "status" });
  private readonly copyButton = make("button", { type: "button", class: "primary", "data-testid": "embed-copy" }, ["Copy"]);
  private readonly closeButton = make("button", { type: "button", "data-testid": "embed-close" }, ["Close"]);
  private readonly dialog = make("dialog", { class: "embed-card glass", "data-testid": "embed-card", "aria-label": "Embed this view" }, [
    make("h2", {}, ["Embed this view"]), this.code, make("div", { class: "buttons" }, [this.copyButton, this.closeButton]), this.note,
  ]);

  constructor() {
    this.copyButton.addEventListener("click", () => void this.copy());
    this.closeButton.addEventListener("click", () => this.dialog.close());
    // The page's own keys choose tools.
    this.dialog.addEventListener("keydown", (event) => event.stopPropagation());
    document.body.append(this.dialog);
  }

  open(code: string): void {
    this.code.value = code;
    this.code.setSelectionRange(0, 0);
    setText(this.note, kNote);
    this.dialog.showModal();
    this.copyButton.focus();
  }

  private async copy(): Promise<void> {
    setText(this.note, (await this.isCopied()) ? `The code is copied. ${kNote}` : "The browser does not allow to copy: select the code and copy it by hand.");
  }

  private async isCopied(): Promise<boolean> {
    try {
      await navigator.clipboard.writeText(this.code.value);
      return true;
    } catch {
      // Pages by plain HTTP have no clipboard; the older call works there.
      this.code.select();
      return document.execCommand("copy");
    }
  }
}

// The card that shares a view of the water: its link to copy, for another program (Web Share), and as a QR code.
import { make, setText } from "./dom";
import { drawQrCode } from "./qr_code";
import "./share_card.css";

/** Longer links make codes so fine that phones do not read them from a screen. */
const kQrMaxLength = 1200;
const kLoopbackHost = /^(localhost|.*\.localhost|127(\.\d+){3}|\[::1\])$/;
const kOnlyHereText = "Only this computer can open this link: start the server with --address 0.0.0.0 for phones and other computers.";
const kOwnHostText = "Other devices of the network reach this server at the address in this link.";

/** What the card needs of the page. */
export interface ShareSource {
  /** Returns the page's address with all that was chosen up to now. */
  address(): string;
  /** Asks the server at which addresses other devices reach its pad. */
  joinAddresses(): Promise<string[]>;
}

/** Returns the page's address as other devices open it, from the address of the pad at which they reach the server. */
export function addressAt(padUrl: string, page: string): string {
  const url = new URL(".", padUrl);
  url.search = new URL(page).search;
  return url.href;
}

export class ShareCard {
  private readonly qr = make("canvas", { "data-testid": "share-qr", role: "img", "aria-label": "QR code of the link" });
  private readonly link = make("input", { id: "share-link", "data-testid": "share-link", readonly: "", "aria-label": "Link" });
  private readonly copyButton = make("button", { type: "button", class: "primary", "data-testid": "share-copy" }, ["Copy"]);
  private readonly sendButton = make("button", { type: "button", "data-testid": "share-send" }, ["Send …"]);
  private readonly closeButton = make("button", { type: "button", "data-testid": "share-close" }, ["Close"]);
  private readonly note = make("p", { class: "hint", "data-testid": "share-note", role: "status" });
  private readonly dialog = make("dialog", { class: "share-card", "data-testid": "share-card", "aria-label": "Share this view" }, [
    make("div", {}, [make("h2", {}, ["Share this view"]), this.qr, this.link, make("div", { class: "share-buttons" }, [this.copyButton, this.sendButton, this.closeButton]), this.note]),
  ]);

  constructor(private readonly source: ShareSource) {
    this.sendButton.hidden = typeof navigator.share !== "function";
    this.copyButton.addEventListener("click", () => void this.copy());
    this.sendButton.addEventListener("click", () => void this.send());
    this.closeButton.addEventListener("click", () => this.dialog.close());
    this.link.addEventListener("focus", () => this.link.select());
    this.dialog.addEventListener("click", ({ target }) => target === this.dialog && this.dialog.close());
    // The page's own keys choose tools.
    this.dialog.addEventListener("keydown", (event) => event.stopPropagation());
    document.body.append(this.dialog);
  }

  open(): void {
    const page = this.source.address();
    this.show(page, "");
    this.dialog.showModal();
    this.copyButton.focus();
    if (kLoopbackHost.test(new URL(page).hostname)) void this.showReachable(page);
  }

  /** Shows the link with this computer's address in its network: "localhost" is another computer elsewhere. */
  private async showReachable(page: string): Promise<void> {
    const [first] = await this.source.joinAddresses().catch((): string[] => []);
    if (first === undefined) this.show(page, kOnlyHereText);
    else this.show(addressAt(first, page), kOwnHostText);
  }

  private show(link: string, note: string): void {
    this.link.value = link;
    this.qr.hidden = link.length > kQrMaxLength;
    if (!this.qr.hidden) drawQrCode(this.qr, link);
    this.qr.dataset["address"] = link;
    setText(this.note, this.qr.hidden ? `The link is too long for a QR code. ${note}` : note);
  }

  private async copy(): Promise<void> {
    setText(this.note, (await this.isCopied()) ? "The link is copied." : "The browser does not allow to copy: select the link and copy it by hand.");
  }

  private async isCopied(): Promise<boolean> {
    try {
      await navigator.clipboard.writeText(this.link.value);
      return true;
    } catch {
      // Pages by plain HTTP have no clipboard; the older call works there.
      this.link.select();
      return document.execCommand("copy");
    }
  }

  private async send(): Promise<void> {
    try {
      await navigator.share({ title: document.title, url: this.link.value });
    } catch (error) {
      // Who closes the browser's list has changed one's mind.
      if (!(error instanceof DOMException && error.name === "AbortError")) setText(this.note, "The browser cannot send the link: copy it.");
    }
  }
}

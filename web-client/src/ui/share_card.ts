// The card that shares a view of the water: a link to copy, for another program (Web Share), and as a QR code. The link leads to this room;
// to a room of its own with the same scene and values; or, from an operator, to a new room in the role of presenter, player or watcher. Or it
// gives the code that shows the view in another page.
import type { RoleName } from "../codec/people";
import { textOfValues, type ParameterValue } from "../net/room_address";
import type { RoomWithTokens } from "../net/room_requests";
import { make, setText } from "./dom";
import { embedCode } from "./embed_code";
import { drawQrCode } from "./qr_code";
import { SelectRow } from "./select_row";
import { addressAt, linkWith } from "./share_link";
import "./share_card.css";

/** Longer links make codes so fine that phones do not read them from a screen. */
const kQrMaxLength = 1200;
const kLoopbackHost = /^(localhost|.*\.localhost|127(\.\d+){3}|\[::1\])$/;
const kOnlyHereText = "Only this computer can open this link: start the server with --address 0.0.0.0 for phones and other computers.";
const kTargets = { room: "this room, with everybody in it", copy: "a room of its own like this one", roles: "a new room, by roles", embed: "a page of yours, as code" } as const;
type Target = keyof typeof kTargets;
const kRoles: Record<RoleName, string> = { operator: "the presenter", player: "players", viewer: "watchers" };
const kTargetNotes: Record<Target, string> = {
  room: "",
  copy: "Everybody with this link comes into one room, apart from this one. An operator has to open it first.",
  roles: "Whoever has the link has the role, until the room ends. The links are shown until this page is closed.",
  embed: "The server shows its water only in pages that it lists: start it with --embed and the origin of your page, such as https://school.example.",
};

/** What the card needs of the page. */
export interface ShareSource {
  /** Returns the page's address with all that was chosen up to now. */
  address(): string;
  /** The scene with which a room can be opened as this one was; undefined if the server has no such scene. */
  scene(): string | undefined;
  /** This page may open rooms. */
  mayOpen(): boolean;
  /** Asks the server at which addresses other devices reach its pad. */
  joinAddresses(): Promise<string[]>;
  /** Asks the server for the values that were changed in this room. */
  changes(): Promise<ParameterValue[]>;
  /** Opens a room like this one with a token for each role. */
  openForRoles(): Promise<RoomWithTokens>;
}

export class ShareCard {
  private page = "";
  private values: ParameterValue[] = [];
  private reachable: string | undefined;
  private isOnlyHere = false;
  private target: Target = "room";
  private role: RoleName = "player";
  private made: RoomWithTokens | undefined;
  private readonly qr = make("canvas", { "data-testid": "share-qr", role: "img", "aria-label": "QR code of the link" });
  private readonly link = make("input", { "data-testid": "share-link", readonly: "", "aria-label": "Link" });
  private readonly targetRow = new SelectRow("share-target", "Leads to", "Where the link leads.", (value) => this.choose(value as Target));
  private readonly roleRow = new SelectRow("share-role", "For", "The role of those who open the link.", (value) => {
    this.role = value as RoleName;
    this.show();
  });
  private readonly copyButton = make("button", { type: "button", class: "primary", "data-testid": "share-copy" }, ["Copy"]);
  private readonly sendButton = make("button", { type: "button", "data-testid": "share-send" }, ["Send …"]);
  private readonly closeButton = make("button", { type: "button", "data-testid": "share-close" }, ["Close"]);
  private readonly note = make("p", { class: "hint", "data-testid": "share-note", role: "status" });
  private readonly dialog = make("dialog", { class: "share-card", "data-testid": "share-card", "aria-label": "Share this view" }, [
    make("div", {}, [
      make("h2", {}, ["Share this view"]),
      this.targetRow.element,
      this.roleRow.element,
      this.qr,
      this.link,
      make("div", { class: "share-buttons" }, [this.copyButton, this.sendButton, this.closeButton]),
      this.note,
    ]),
  ]);

  constructor(private readonly source: ShareSource) {
    this.sendButton.hidden = typeof navigator.share !== "function";
    this.roleRow.setChoices(Object.entries(kRoles).map(([value, label]) => ({ value, label })), this.role);
    this.copyButton.addEventListener("click", () => void (this.isReady ? this.copy() : this.openForRoles()));
    this.sendButton.addEventListener("click", () => void this.send());
    this.closeButton.addEventListener("click", () => this.dialog.close());
    this.link.addEventListener("focus", () => this.link.select());
    this.dialog.addEventListener("click", ({ target }) => target === this.dialog && this.dialog.close());
    // The page's own keys choose tools.
    this.dialog.addEventListener("keydown", (event) => event.stopPropagation());
    document.body.append(this.dialog);
  }

  open(): void {
    this.page = this.source.address();
    this.target = "room";
    this.values = [];
    const targets: Target[] = ["room", ...(this.source.scene() === undefined ? [] : ["copy" as const, ...(this.source.mayOpen() ? ["roles" as const] : [])]), "embed"];
    this.targetRow.setChoices(targets.map((value) => ({ value, label: kTargets[value] })), this.target);
    this.show();
    this.dialog.showModal();
    this.copyButton.focus();
    void this.ask();
  }

  /** Asks what the server knows: the values, and this computer's address in its network where the page's is "localhost", which is another computer elsewhere. */
  private async ask(): Promise<void> {
    const isLoopback = kLoopbackHost.test(new URL(this.page).hostname);
    const [values, addresses] = await Promise.all([this.source.changes().catch(() => []), isLoopback ? this.source.joinAddresses().catch(() => []) : []]);
    this.values = values;
    this.reachable = addresses[0];
    this.isOnlyHere = isLoopback && this.reachable === undefined;
    this.show();
  }

  /** False: the room of the link has to be opened first. */
  private get isReady(): boolean {
    return this.target !== "roles" || this.made !== undefined;
  }

  private choose(target: Target): void {
    this.target = target;
    this.show();
  }

  private async openForRoles(): Promise<void> {
    this.copyButton.disabled = true;
    this.tell("Opening the room: this takes some seconds.");
    try {
      this.made = await this.source.openForRoles();
      this.show();
    } catch (error) {
      this.copyButton.disabled = false;
      if (this.target === "roles") this.tell(`The room could not be opened: ${error instanceof Error ? error.message : String(error)}`);
    }
  }

  private show(): void {
    const { target, isReady } = this;
    this.roleRow.element.hidden = target !== "roles" || !isReady;
    setText(this.copyButton, isReady ? "Copy" : "Open the room");
    this.copyButton.disabled = false;
    this.sendButton.disabled = !isReady;
    const link = isReady ? this.linkNow() : "";
    this.link.value = this.qr.dataset["address"] = link;
    const isDrawn = link !== "" && link.length <= kQrMaxLength && target !== "embed";
    this.qr.hidden = !isDrawn;
    if (isDrawn) drawQrCode(this.qr, link);
    this.tell([link.length > kQrMaxLength && target !== "embed" ? "The link is too long for a QR code." : "", kTargetNotes[target], this.isOnlyHere ? kOnlyHereText : ""].filter(Boolean).join(" "));
  }

  private linkNow(): string {
    const page = this.reachable === undefined ? this.page : addressAt(this.reachable, this.page);
    if (this.target === "embed") return embedCode(page);
    if (this.target === "room") return linkWith(page, {}, "");
    if (this.target === "copy") return linkWith(page, { room: undefined, scene: this.source.scene(), set: textOfValues(this.values) }, "");
    return linkWith(page, { room: this.made!.room, scene: undefined, set: undefined }, this.made!.tokens[this.role]);
  }

  private tell(text: string): void {
    setText(this.note, text);
  }

  private async copy(): Promise<void> {
    this.tell((await this.isCopied()) ? "It is copied." : "The browser does not allow to copy: select the text and copy it by hand.");
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
      if (!(error instanceof DOMException && error.name === "AbortError")) this.tell("The browser cannot send the link: copy it.");
    }
  }
}

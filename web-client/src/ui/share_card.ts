// The card that shares a view of the water: a link to copy, for another program (Web Share), and as a QR code. The link leads to this room;
// to a room of its own with the same scene and values; or, from an operator, to a new room in the role of presenter, player or watcher, or as
// a kiosk. Or it gives the code that shows the view in another page.
import type { RoleName } from "../../client/codec/people";
import type { ParameterValue } from "../../client/rest/rooms";
import { textOfValues } from "../net/room_address";
import type { RoomWithTokens } from "../../client/rest/rooms";
import { makeCard } from "./card";
import { make, setText } from "./dom";
import { embedCode } from "./embed_code";
import { drawQrCode } from "./qr_code";
import { SelectRow } from "./select_row";
import { addressAt, linkWith } from "./share_link";
import "./share_card.css";
import { kShareTexts } from "./share_texts";

/** Longer links make codes so fine that phones do not read them from a screen. */
const kQrMaxLength = 1200;
const kLoopbackHost = /^(localhost|.*\.localhost|127(\.\d+){3}|\[::1\])$/;
type Target = keyof typeof kShareTexts.targets;
/** The reader of a link to a new room: a role, or the visitors of a kiosk, who are players. */
type Guest = RoleName | "kiosk";
/** Until the countdown of a kiosk; in the link, so that one sees where it can be changed. */
const kKioskIdleS = "60";

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
  private guest: Guest = "player";
  private made: RoomWithTokens | undefined;
  private readonly qr = make("canvas", { "data-testid": "share-qr", role: "img", "aria-label": kShareTexts.qr });
  private readonly link = make("input", { "data-testid": "share-link", readonly: "", "aria-label": kShareTexts.link });
  private readonly targetRow = new SelectRow("share-target", kShareTexts.target, (value) => this.choose(value as Target));
  private readonly roleRow = new SelectRow("share-role", kShareTexts.role, (value) => {
    this.guest = value as Guest;
    this.show();
  });
  private readonly copyButton = make("button", { type: "button", class: "primary", "data-testid": "share-copy" }, [kShareTexts.copy]);
  private readonly sendButton = make("button", { type: "button", "data-testid": "share-send" }, [kShareTexts.send]);
  private readonly closeButton = make("button", { type: "button", "data-testid": "share-close" }, [kShareTexts.close]);
  private readonly note = make("p", { class: "hint", "data-testid": "share-note", role: "status" });
  private readonly dialog = makeCard("share-card", kShareTexts.title, [
    make("div", {}, [
      make("h2", {}, [kShareTexts.title]),
      this.targetRow.element,
      this.roleRow.element,
      this.qr,
      this.link,
      make("div", { class: "share-buttons" }, [this.copyButton, this.sendButton, this.closeButton]),
      this.note,
    ]),
  ], this.closeButton);

  constructor(private readonly source: ShareSource) {
    this.sendButton.hidden = typeof navigator.share !== "function";
    this.roleRow.setChoices(Object.entries(kShareTexts.roles).map(([value, label]) => ({ value, label })), this.guest);
    this.copyButton.addEventListener("click", () => void (this.isReady ? this.copy() : this.openForRoles()));
    this.sendButton.addEventListener("click", () => void this.send());
    this.link.addEventListener("focus", () => this.link.select());
  }

  open(): void {
    this.page = this.source.address();
    this.target = "room";
    this.values = [];
    const targets: Target[] = ["room", ...(this.source.scene() === undefined ? [] : ["copy" as const, ...(this.source.mayOpen() ? ["roles" as const] : [])]), "embed"];
    this.targetRow.setChoices(targets.map((value) => ({ value, label: kShareTexts.targets[value] })), this.target);
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
    this.tell(kShareTexts.opening);
    try {
      this.made = await this.source.openForRoles();
      this.show();
    } catch (error) {
      this.copyButton.disabled = false;
      if (this.target === "roles") this.tell(kShareTexts.notOpened(error instanceof Error ? error.message : String(error)));
    }
  }

  private show(): void {
    const { target, isReady } = this;
    this.roleRow.element.hidden = target !== "roles" || !isReady;
    setText(this.copyButton, isReady ? kShareTexts.copy : kShareTexts.openRoom);
    this.copyButton.disabled = false;
    this.sendButton.disabled = !isReady;
    const link = isReady ? this.linkNow() : "";
    this.link.value = this.qr.dataset["address"] = link;
    const isDrawn = link !== "" && link.length <= kQrMaxLength && target !== "embed";
    this.qr.hidden = !isDrawn;
    if (isDrawn) drawQrCode(this.qr, link);
    this.tell([link.length > kQrMaxLength && target !== "embed" ? kShareTexts.tooLong : "", kShareTexts.notes[target], target === "roles" && isReady && this.guest === "kiosk" ? kShareTexts.kioskNote : "", this.isOnlyHere ? kShareTexts.onlyHere : ""].filter(Boolean).join(" "));
  }

  private linkNow(): string {
    const page = this.reachable === undefined ? this.page : addressAt(this.reachable, this.page);
    if (this.target === "embed") return embedCode(page);
    if (this.target === "room") return linkWith(page, {}, "");
    if (this.target === "copy") return linkWith(page, { room: undefined, scene: this.source.scene(), set: textOfValues(this.values) }, "");
    const { room, tokens } = this.made!;
    const newRoom = { room, scene: undefined, set: undefined };
    if (this.guest === "kiosk") return linkWith(page, { ...newRoom, kiosk: kKioskIdleS, view: undefined, camera: undefined }, tokens.player);
    return linkWith(page, newRoom, tokens[this.guest]);
  }

  private tell(text: string): void {
    setText(this.note, text);
  }

  private async copy(): Promise<void> {
    this.tell((await this.isCopied()) ? kShareTexts.copied : kShareTexts.notCopied);
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
      if (!(error instanceof DOMException && error.name === "AbortError")) this.tell(kShareTexts.notSent);
    }
  }
}

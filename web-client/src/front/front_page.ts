// The front page of a server: its rooms as cards with live pictures, and for operators a card that opens one.
import "./front.css";
import { takeLinkToken } from "../app/address";
import { takeRefusal } from "../app/to_front";
import type { RoleName } from "../../client/codec/people";
import { IdentityStore, sessionStorageIfAny } from "../net/identity_store";
import { kNetTexts } from "../net/net_texts";
import { roomOf } from "../net/room_address";
import { requestRooms, type RoomSummary } from "../../client/rest/rooms";
import { socketUrl } from "../net/water_client";
import { make, setText } from "../ui/dom";
import { kFrontTexts } from "../ui/front_texts";
import { kTexts } from "../ui/texts";
import { chooseLive } from "./front_model";
import { OpenCard } from "./open_card";
import { RoomCard } from "./room_card";

const kListEveryMs = 4000;
const kDrawEveryMs = 100;

export function openFront(): void {
  const front = new FrontPage();
  Object.defineProperty(window, "spindriftFront", { value: Object.freeze({ stats: () => front.stats() }) });
}

class FrontPage {
  private readonly token: string;
  private readonly cards = new Map<string, RoomCard>();
  private readonly inWindow = new Set<string>();
  private readonly list = make("ul", { class: "front-rooms", "aria-label": kFrontTexts.rooms });
  private readonly missingLine = make("p", { class: "front-missing", role: "alert", "data-testid": "front-missing", hidden: "" });
  private readonly failedLine = make("p", { "data-testid": "front-failed" });
  private readonly failed = make("div", { class: "front-failed", role: "status", hidden: "" }, [this.failedLine]);
  private readonly nobody = make("p", { class: "hint", hidden: "" }, [kFrontTexts.noRooms]);
  private readonly openCard: OpenCard;
  private readonly wanted = roomOf(location.search);
  private readonly observer: IntersectionObserver;
  private listTimer = 0;
  private isAsking = false;
  private drawnMs = 0;

  constructor() {
    const identities = new IdentityStore(sessionStorageIfAny(), socketUrl(location.href));
    const linkToken = takeLinkToken(location, history);
    // Without a new token the store stays as it is, with the resume key of the room that the visitor comes from.
    this.token = linkToken === undefined ? identities.peek().token : identities.load(linkToken).token;
    this.openCard = new OpenCard(this.token);
    this.list.append(this.openCard.element);
    const retry = make("button", { type: "button", "data-testid": "front-retry" }, [kTexts.page.retry]);
    retry.addEventListener("click", () => this.ask());
    this.failed.append(retry);
    const main = make("main", { class: "front" }, [
      make("header", {}, [make("h1", {}, ["Spindrift"]), make("p", {}, [kFrontTexts.lead])]),
      this.missingLine,
      this.failed,
      this.nobody,
      this.list,
    ]);
    document.body.replaceChildren(main);
    this.observer = new IntersectionObserver((entries) => this.seen(entries), { root: main });
    document.addEventListener("visibilitychange", () => {
      this.connect();
      if (!document.hidden) this.ask();
    });
    // A page that the browser keeps for "Back" holds no connection; shown again it connects anew.
    window.addEventListener("pagehide", () => this.connect(true));
    window.addEventListener("pageshow", ({ persisted }) => persisted && this.connect());
    // A link with a token was opened in this tab.
    window.addEventListener("hashchange", () => location.reload());
    this.sayMissing(takeRefusal());
    this.ask();
    const frame = (nowMs: number): void => {
      requestAnimationFrame(frame);
      if (nowMs - this.drawnMs < kDrawEveryMs) return;
      this.drawnMs = nowMs;
      for (const card of this.cards.values()) card.draw(performance.now() / 1000);
    };
    requestAnimationFrame(frame);
  }

  /** Measured values for tests and the browser's console. */
  stats() {
    return { rooms: [...this.cards.values()].map(({ name, isConnected, simTimeS }) => ({ name, isConnected, simTimeS })) };
  }

  private sayMissing(refusal: string | undefined): void {
    if (!this.wanted) return;
    setText(this.missingLine, refusal ? kFrontTexts.refusedRoom(refusal) : kFrontTexts.noSuchRoom(this.wanted));
    this.missingLine.hidden = false;
  }

  /** Asks for the list of rooms now, and again every few seconds while the page is shown. */
  private ask(): void {
    window.clearTimeout(this.listTimer);
    if (this.isAsking || document.hidden) return;
    this.isAsking = true;
    requestRooms(this.token)
      .then(
        (rooms) => this.show(rooms),
        (error: unknown) => this.fail(error instanceof TypeError ? kNetTexts.serverSilent : error instanceof Error ? error.message : String(error)),
      )
      .finally(() => {
        this.isAsking = false;
        this.listTimer = window.setTimeout(() => this.ask(), kListEveryMs);
      });
  }

  private fail(why: string): void {
    setText(this.failedLine, kFrontTexts.listFailed(why));
    this.failed.hidden = false;
  }

  private show(rooms: readonly RoomSummary[]): void {
    this.failed.hidden = true;
    this.nobody.hidden = rooms.length > 0;
    if (rooms.some(({ name }) => name === this.wanted)) this.missingLine.hidden = true;
    for (const [name, card] of this.cards)
      if (!rooms.some((room) => room.name === name)) {
        this.observer.unobserve(card.element);
        this.inWindow.delete(name);
        card.remove();
        this.cards.delete(name);
      }
    for (const room of rooms) {
      const known = this.cards.get(room.name);
      const card = known ?? new RoomCard(room.name);
      card.show(room);
      if (known) continue;
      this.cards.set(room.name, card);
      this.openCard.element.before(card.element);
      card.element.dataset["room"] = room.name;
      this.observer.observe(card.element);
    }
    this.connect();
  }

  private seen(entries: readonly IntersectionObserverEntry[]): void {
    for (const { target, isIntersecting } of entries) {
      const name = (target as HTMLElement).dataset["room"]!;
      if (isIntersecting && this.cards.has(name)) this.inWindow.add(name);
      else this.inWindow.delete(name);
    }
    this.connect();
  }

  /** Connects the pictures that are to be live, and no others. */
  private connect(isLeaving = document.hidden): void {
    const names = [...this.cards.keys()];
    const live = new Set(names.filter((name) => this.cards.get(name)!.isConnected));
    const wanted = chooseLive(names.filter((name) => this.inWindow.has(name)), live, isLeaving);
    for (const [name, card] of this.cards) card.setLive(wanted.includes(name), this.token, (role) => this.welcomed(role));
  }

  /** Operators may open rooms. */
  private welcomed(role: RoleName): void {
    if (role === "operator") this.openCard.show();
  }
}

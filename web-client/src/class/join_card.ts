// How to join: the address of the pad in large letters, and as a QR code. Large while nobody is in, in a corner while people play.
import { askJoinAddresses } from "../net/join_addresses";
import { roomOf } from "../net/room_address";
import { make, setText } from "../ui/dom";
import { drawQrCode } from "../ui/qr_code";
import { kClassTexts } from "../ui/class_texts";

/** Returns the addresses of the pad as this server's network has them. Throws an Error with a line for people. */
export async function joinAddresses(search: string, token: string): Promise<string[]> {
  const urls = await askJoinAddresses(token);
  if (urls.length === 0) throw new Error(kClassTexts.phonesCannotJoin);
  return urls.map((url) => withRoom(url, search));
}

/** Returns the address of the pad of the room that the projector shows. */
export function withRoom(address: string, search: string): string {
  const room = roomOf(search);
  const url = new URL(address);
  if (room) url.searchParams.set("room", room);
  return url.href;
}

/** As one types it. */
export function spokenAddress(address: string): string {
  return address.replace(/^http:\/\//, "").replace(/\/$/, "");
}

export class JoinCard {
  readonly element = make("button", { type: "button", class: "join-card", "data-testid": "join-card", title: kClassTexts.joinTip, hidden: "" });
  private readonly canvas = make("canvas", { "data-testid": "join-qr", role: "img", "aria-label": kClassTexts.padQr });
  private readonly address = make("strong", { "data-testid": "join-address" });
  private readonly more = make("small");
  private addresses: string[] = [];
  private shown = 0;
  /** By hand. */
  private wantsLarge: boolean | undefined;
  private isEmpty = true;

  constructor() {
    this.element.append(this.canvas, make("span", { class: "join-text" }, [make("span", {}, [kClassTexts.scanOrOpen]), this.address, this.more]));
    this.element.addEventListener("click", () => this.clicked());
  }

  show(addresses: string[]): void {
    this.addresses = addresses;
    this.element.hidden = addresses.length === 0;
    this.draw();
  }

  /** `isEmpty`: nobody plays yet. */
  setPlayers(isEmpty: boolean): void {
    if (isEmpty !== this.isEmpty) this.wantsLarge = undefined;
    this.isEmpty = isEmpty;
    this.refresh();
  }

  /** A click makes it large; while it is large, the next address, and small again after the last one. */
  private clicked(): void {
    if (!this.isLarge) this.wantsLarge = true;
    else if (this.shown + 1 < this.addresses.length) ++this.shown;
    else {
      this.shown = 0;
      this.wantsLarge = false;
    }
    this.draw();
  }

  private get isLarge(): boolean {
    return this.wantsLarge ?? this.isEmpty;
  }

  private refresh(): void {
    this.element.classList.toggle("large", this.isLarge);
  }

  private draw(): void {
    const address = this.addresses[this.shown];
    if (address === undefined) return;
    drawQrCode(this.canvas, address);
    this.canvas.dataset["address"] = address;
    setText(this.address, spokenAddress(address));
    setText(this.more, this.addresses.length > 1 ? kClassTexts.addressOf(this.shown + 1, this.addresses.length) : "");
    this.refresh();
  }
}

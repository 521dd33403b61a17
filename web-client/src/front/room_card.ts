// The card of a room on the front page: a link with its picture, title, scene, people and state.
import { posterOf } from "../app/poster";
import type { RoleName } from "../../client/codec/people";
import type { RoomSummary } from "../../client/rest/rooms";
import { make, setText } from "../ui/dom";
import { addressOfRoom } from "../ui/room_links";
import { kFrontTexts } from "../ui/front_texts";
import { kTexts } from "../ui/texts";
import { stateOf } from "./front_model";
import { LivePicture } from "./live_picture";

export class RoomCard {
  readonly element: HTMLLIElement;
  private readonly link: HTMLAnchorElement;
  private readonly still = make("img", { alt: "" });
  private readonly canvas = make("canvas", { "aria-hidden": "true", hidden: "" });
  private readonly title = make("strong");
  private readonly scene = make("span", { class: "front-scene" });
  private readonly people = make("span", { class: "front-people" });
  private readonly state = make("span", { class: "front-state" });
  private readonly page: string;
  private picture: LivePicture | undefined;

  constructor(readonly name: string) {
    this.page = addressOfRoom(location.href, name);
    this.link = make("a", { class: "front-card", href: this.page, "data-testid": `room-${name}` }, [
      make("span", { class: "front-picture" }, [this.still, this.canvas]),
      make("span", { class: "front-words" }, [this.title, this.scene, make("span", { class: "front-line" }, [this.people, this.state])]),
      make("span", { class: "front-open" }, [kFrontTexts.open]),
    ]);
    this.element = make("li", {}, [this.link]);
  }

  get isConnected(): boolean {
    return this.picture !== undefined;
  }

  get simTimeS(): number {
    return this.picture?.simTimeS ?? 0;
  }

  show(room: RoomSummary): void {
    const state = stateOf(room);
    setText(this.title, kTexts.scenes[room.scene]?.title ?? room.title);
    setText(this.scene, kFrontTexts.sceneOfRoom(room.scene, room.name));
    setText(this.people, kFrontTexts.peopleCount(room.peopleCount));
    setText(this.state, kFrontTexts.roomState[state]);
    this.link.dataset["state"] = state;
    const still = posterOf(room.scene);
    this.still.hidden = still === undefined;
    if (still && this.still.getAttribute("src") !== still) this.still.src = still;
  }

  /** Connects the picture to the room, or ends the connection. */
  setLive(isLive: boolean, token: string, welcomed: (role: RoleName) => void): void {
    if (isLive === this.isConnected) return;
    this.picture?.close();
    this.picture = isLive ? new LivePicture(this.canvas, this.page, token, welcomed) : undefined;
    this.link.classList.toggle("live", isLive);
  }

  draw(nowS: number): void {
    this.picture?.draw(nowS);
  }

  remove(): void {
    this.picture?.close();
    this.element.remove();
  }
}

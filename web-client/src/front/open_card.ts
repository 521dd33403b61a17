// The card of the front page that opens a room of a chosen scene, by the link that the water's page reads (net/room_address.ts).
import { posterOf } from "../app/poster";
import { requestScenes } from "../../client/rest/rooms";
import { make, setText } from "../ui/dom";
import { sceneLabel } from "../ui/room_panel";
import { linkWith } from "../ui/share_link";
import { SelectRow } from "../ui/select_row";
import { kFrontTexts } from "../ui/front_texts";
import { kTexts } from "../ui/texts";

export class OpenCard {
  readonly element: HTMLLIElement;
  private readonly still = make("img", { alt: "" });
  private readonly scene = new SelectRow("front-scene", kFrontTexts.openScene, (value) => this.choose(value));
  private readonly link = make("a", { class: "front-open", "data-testid": "front-open-room" }, [kFrontTexts.openRoom]);
  private readonly line = make("p", { class: "hint" }, [kFrontTexts.openRoomWhy]);

  constructor(private readonly token: string) {
    this.element = make("li", { hidden: "" }, [
      make("div", { class: "front-card", "data-testid": "front-open" }, [make("span", { class: "front-picture" }, [this.still]), make("span", { class: "front-words" }, [make("strong", {}, [kFrontTexts.openRoom]), this.line, this.scene.element]), this.link]),
    ]);
  }

  /** Shows the card, with the scenes of the server. */
  show(): void {
    if (!this.element.hidden) return;
    this.element.hidden = false;
    requestScenes(this.token).then(
      (scenes) => {
        this.scene.setChoices(scenes.map((name) => ({ value: name, label: sceneLabel(name) })), scenes[0] ?? "");
        this.choose(scenes[0] ?? "");
      },
      (error: unknown) => setText(this.line, kTexts.failed(kFrontTexts.openRoom, error instanceof Error ? error.message : String(error))),
    );
  }

  private choose(scene: string): void {
    this.link.href = linkWith(location.href, { scene, room: undefined, set: undefined, view: undefined, camera: undefined }, "");
    const still = posterOf(scene);
    this.still.hidden = still === undefined;
    if (still) this.still.src = still;
  }
}

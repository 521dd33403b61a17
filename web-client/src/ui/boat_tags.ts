// Names over the boats that people own. Elements are moved by transforms only, and nothing is measured while drawing. Hidden from screen
// readers: the list of people says the same.
import { Matrix4, type PerspectiveCamera } from "three";

import type { GameInfo } from "../../client/codec/game";
import type { BoatDetail } from "../../client/codec/greeting";
import type { PersonInfo } from "../../client/codec/people";
import type { BodyPose } from "../../client/codec/bodies";
import type { PixelRect } from "../scene/camera/framing";
import { make, setText } from "./dom";
import { areApart, tagPlace, type TagPlace } from "./tag_place";

/** Only so many boats have tags. */
const kTagsMax = 8;
/** Height of a tag's foot over the boat's middle, in boat lengths. */
const kOverBoatLengths = 0.5;

interface Tag {
  boatId: number;
  person: PersonInfo;
  place: TagPlace;
  /** Place in a race. */
  rank: number | undefined;
}

/** Returns at most `most` tags of which none hides another: the first of a race (`rank`) before the others, the nearest before those behind. */
export function tagsApart<T extends Pick<Tag, "place" | "rank">>(tags: readonly T[], most: number): T[] {
  const last = Number.MAX_SAFE_INTEGER;
  const shown: T[] = [];
  for (const tag of [...tags].sort((a, b) => (a.rank ?? last) - (b.rank ?? last) || a.place.awayM - b.place.awayM))
    if (shown.length < most && shown.every(({ place }) => areApart(place, tag.place))) shown.push(tag);
  return shown;
}

export class BoatTags {
  private readonly element = make("div", { class: "boat-tags", "aria-hidden": "true", "data-testid": "boat-tags" });
  private readonly labels = new Map<number, HTMLElement>();
  private owners = new Map<number, PersonInfo>();
  /** Places in a race, by person. */
  private places = new Map<number, number>();
  private lengthsM = new Map<number, number>();
  private readonly seen = new Matrix4();

  /** `before`: the tags lie over this element and under everything after it. */
  constructor(before: Element) {
    before.after(this.element);
  }

  setPeople(people: readonly PersonInfo[]): void {
    this.owners = new Map(people.flatMap((person) => person.boatIds.map((boatId): [number, PersonInfo] => [boatId, person])));
  }

  /** In a race a name has its place before it. */
  setPlaces(game: GameInfo | undefined): void {
    this.places = new Map(game?.kind === "race" && game.phase !== "countdown" ? game.racers.map(({ personId }, n): [number, number] => [personId, n + 1]) : []);
  }

  setBoats(boats: readonly BoatDetail[]): void {
    this.lengthsM = new Map(boats.map(({ boatId, lengthM }) => [boatId, lengthM]));
  }

  /** Called for each picture. `hiddenId`: the boat that the camera follows, which needs no name; 0 for none. */
  update(camera: PerspectiveCamera, poseOf: (boatId: number) => BodyPose | undefined, hiddenId: number, covered: readonly PixelRect[]): void {
    this.seen.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    const found: Tag[] = [];
    for (const [boatId, person] of this.owners) {
      const lengthM = this.lengthsM.get(boatId);
      const pose = boatId === hiddenId || lengthM === undefined ? undefined : poseOf(boatId);
      const place = pose && tagPlace(this.seen, [pose.xM, pose.yM + kOverBoatLengths * lengthM!, pose.zM], window.innerWidth, window.innerHeight, covered);
      if (place) found.push({ boatId, person, place, rank: this.places.get(person.personId) });
    }
    const shown = tagsApart(found, kTagsMax);
    for (const [boatId, label] of this.labels)
      if (!shown.some((tag) => tag.boatId === boatId)) {
        label.remove();
        this.labels.delete(boatId);
      }
    for (const tag of shown) this.show(this.labelOf(tag.boatId), tag);
  }

  private show(label: HTMLElement, { person, place: { xPx, yPx }, rank }: Tag): void {
    setText(label, rank === undefined ? person.name : `${rank}. ${person.name}`);
    label.classList.toggle("away", person.away);
    label.style.setProperty("--owner", person.color);
    label.style.transform = `translate(${xPx.toFixed(1)}px, ${yPx.toFixed(1)}px) translate(-50%, -100%)`;
  }

  private labelOf(boatId: number): HTMLElement {
    let label = this.labels.get(boatId);
    if (!label) {
      label = make("span");
      this.labels.set(boatId, label);
      this.element.append(label);
    }
    return label;
  }
}

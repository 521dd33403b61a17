// Rings over the fingers in the water, in the colours of their people, with names after a moment. One's own follows the pointer, those of
// others are shown as soon as the server's list comes: ahead of the water by the delay of the pictures, as one's own are. Hidden from
// screen readers: they move too fast to be read out.
import { Matrix4, type PerspectiveCamera } from "three";

import type { PersonInfo } from "../../client/codec/people";
import type { FingerInfo } from "../../client/codec/strokes";
import { StrokeTool } from "../../client/gen/spindrift/v1/wire_pb";
import type { PixelRect } from "../scene/camera/framing";
import { make, setText } from "./dom";
import { tagPlace } from "./tag_place";
import type { Outline } from "./tool_preview";

/** A name is shown from then on, so that short strokes do not flicker. */
const kNameAfterS = 1;

interface Ring {
  element: HTMLElement;
  name: HTMLElement;
  sinceS: number;
}

export class FingerTags {
  private readonly element = make("div", { class: "finger-tags", "aria-hidden": "true", "data-testid": "finger-tags" });
  private readonly rings = new Map<string, Ring>();
  private fingers: readonly FingerInfo[] = [];
  private people = new Map<number, PersonInfo>();
  private readonly seen = new Matrix4();

  /** `before`: the rings lie over this element and under everything after it. */
  constructor(before: Element) {
    before.after(this.element);
  }

  setPeople(people: readonly PersonInfo[]): void {
    this.people = new Map(people.map((person) => [person.personId, person]));
  }

  take(fingers: readonly FingerInfo[]): void {
    this.fingers = fingers;
  }

  /** Those that the server named last. */
  get list(): readonly FingerInfo[] {
    return this.fingers;
  }

  clear(): void {
    this.fingers = [];
  }

  /** The discs on which everybody's tools act now. */
  discs(): Outline[] {
    return this.fingers
      .filter(({ tool }) => tool === StrokeTool.RAIN || tool === StrokeTool.CALM)
      .map(({ tool, personId, xM, zM, radiusM }) => ({ kind: tool === StrokeTool.RAIN ? "rain" : "disc", at: { xM, zM }, radiusM, color: this.colorOf(personId) }));
  }

  private colorOf(personId: number): string {
    return this.people.get(personId)?.color ?? "#ffffff";
  }

  /** Called for each picture. `own`: where one's own fingers are now; `ownId`: whose the list's are left out. */
  update(camera: PerspectiveCamera, own: ReadonlyMap<number, { xM: number; zM: number }>, ownId: number, heightAtM: (xM: number, zM: number) => number, covered: readonly PixelRect[], nowS: number): void {
    this.seen.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    const drawn = new Set<string>();
    const show = (key: string, personId: number, xM: number, zM: number, named: boolean): void => {
      const place = tagPlace(this.seen, [xM, heightAtM(xM, zM), zM], window.innerWidth, window.innerHeight, covered);
      if (!place) return;
      drawn.add(key);
      const ring = this.ringOf(key, nowS);
      ring.element.style.setProperty("--owner", this.colorOf(personId));
      ring.element.style.transform = `translate(${place.xPx.toFixed(1)}px, ${place.yPx.toFixed(1)}px)`;
      setText(ring.name, named && nowS - ring.sinceS >= kNameAfterS ? (this.people.get(personId)?.name ?? "") : "");
    };
    for (const [pointerId, { xM, zM }] of own) show(`own ${pointerId}`, ownId, xM, zM, false);
    for (const { personId, strokeId, xM, zM } of this.fingers) if (personId !== ownId || ownId === 0) show(`${personId} ${strokeId}`, personId, xM, zM, true);
    for (const [key, { element }] of this.rings)
      if (!drawn.has(key)) {
        element.remove();
        this.rings.delete(key);
      }
  }

  private ringOf(key: string, nowS: number): Ring {
    let ring = this.rings.get(key);
    if (!ring) {
      const name = make("span");
      ring = { element: make("div", {}, [name]), name, sinceS: nowS };
      this.rings.set(key, ring);
      this.element.append(ring.element);
    }
    return ring;
  }
}

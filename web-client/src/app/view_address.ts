// The view in the page's address: `?view=side`, or, where somebody has moved the camera, `?camera=` with its position and what it looks at, as
// six numbers in metres.
import type { Vector3 } from "three";

import type { CameraViews, ViewName } from "../scene/camera/camera_views";
import { clamp } from "../scene/maths/interpolate";
import { setAddressParameter } from "./address";

type Place = [number, number, number];
type AddressView = { view: ViewName } | { eyeM: Place; targetM: Place };

/** Views that a page can begin with; the boat's needs a boat, and "start" is the first one anyway. */
const kFirstViews: readonly ViewName[] = ["side", "overview", "below"];
const kFarthestM = 1e4;
/** The camera has to rest for so long before the address says where it is. */
const kRestS = 0.7;
const kLookEveryS = 0.25;

/** Undefined: the first view of the scene. */
export function viewOf(search: string): AddressView | undefined {
  const parameters = new URLSearchParams(search);
  const numbers = (parameters.get("camera") ?? "").split(",").map(Number);
  if (numbers.length === 6 && numbers.every((each) => Math.abs(each) < kFarthestM)) {
    const [eyeM, targetM] = [numbers.slice(0, 3) as Place, numbers.slice(3) as Place];
    if (Math.hypot(...eyeM.map((each, axis) => each - targetM[axis]!)) > 1e-3) return { eyeM, targetM };
  }
  const view = kFirstViews.find((name) => name === parameters.get("view"));
  return view && { view };
}

/** Returns the decimals that move a picture by less than a pixel: a ten-thousandth of the distance. */
function decimalsAt(distanceM: number): number {
  return clamp(Math.ceil(4 - Math.log10(Math.max(distanceM, 0.01))), 0, 6);
}

export class ViewAddress {
  private first = viewOf(location.search);
  private seen = "";
  private seenSinceS = 0;
  private nextS = 0;
  private isWritten = true;

  constructor(
    private readonly views: CameraViews,
    private readonly eyeM: Vector3,
  ) {}

  /** Shows the view of the address, once, when there is water. */
  enter(nowS: number): void {
    const { first, views } = this;
    this.first = undefined;
    if (!first) return;
    if (!("view" in first)) views.place(first.eyeM, first.targetM);
    else if (first.view !== "below" || views.canDive) views.go(first.view, nowS);
  }

  /** Call it after each picture. */
  update(nowS: number): void {
    if (nowS < this.nextS) return;
    this.nextS = nowS + kLookEveryS;
    this.look(nowS);
    if (nowS - this.seenSinceS >= kRestS) this.write();
  }

  /** Writes where the camera is now, at rest or not. */
  writeNow(nowS: number): void {
    this.look(nowS);
    this.write();
  }

  private look(nowS: number): void {
    const { view, targetM } = this.views;
    const now = view ?? [...this.eyeM, ...targetM].map((each) => Number(each.toFixed(decimalsAt(this.eyeM.distanceTo(targetM))))).join(",");
    if (now === this.seen) return;
    this.isWritten = this.seen === "" && view !== undefined;
    this.seen = now;
    this.seenSinceS = nowS;
  }

  private write(): void {
    if (this.isWritten) return;
    this.isWritten = true;
    const { view } = this.views;
    setAddressParameter("view", view !== undefined && kFirstViews.includes(view) ? view : undefined);
    setAddressParameter("camera", view === undefined ? this.seen : undefined);
  }
}

// Tells a camera that the user moved from one that the page moved, and a move from a press: a click turns the camera by a few pixels,
// because hands are not steady.
import { Spherical, Vector3 } from "three";
import type { OrbitControls } from "three/addons/controls/OrbitControls.js";

import { wrapAngle } from "../maths/interpolate";

/** A press that moves the pointer no farther than this is a click. */
export const kClickRadiusPx = 6;
/** Relative change of the distance that counts as a move. A step of the wheel is a hundred times as much. */
const kLeastZoom = 1e-4;

export class CameraHand {
  /** Turn by the user since the last press; undefined: no press and no key since the page chose a view. */
  private turn: { thetaRad: number; phiRad: number } | undefined;
  private isUpdating = false;
  private readonly seen = new Spherical();
  private readonly now = new Spherical();
  private readonly offsetM = new Vector3();

  /** `moved`: the user has moved the camera. */
  constructor(
    private readonly controls: OrbitControls,
    private readonly moved: () => void,
  ) {
    controls.addEventListener("start", () => (this.turn = { thetaRad: 0, phiRad: 0 }));
    controls.addEventListener("change", () => this.changed());
  }

  /** Forgets earlier presses: the page has chosen a view. */
  release(): void {
    this.turn = undefined;
  }

  /** Updates the controls. Call it after the page has placed camera or target. */
  update(): void {
    this.read(this.seen);
    this.isUpdating = true;
    this.controls.update();
    this.isUpdating = false;
  }

  /** Takes a camera that the page has placed without the controls. */
  placed(): void {
    this.read(this.seen);
  }

  private changed(): void {
    // Without a press the update only keeps the camera within its bounds.
    if (this.isUpdating && !this.turn) return;
    const turn = (this.turn ??= { thetaRad: 0, phiRad: 0 });
    const { seen, now } = this;
    this.read(now);
    turn.thetaRad += wrapAngle(now.theta - seen.theta);
    turn.phiRad += now.phi - seen.phi;
    const isZoomed = !this.isUpdating && Math.abs(now.radius - seen.radius) > kLeastZoom * seen.radius;
    seen.copy(now);
    const clickRad = (2 * Math.PI * kClickRadiusPx) / Math.max(this.controls.domElement!.clientHeight, 1);
    if (isZoomed || Math.hypot(turn.thetaRad, turn.phiRad) > clickRad) this.moved();
  }

  private read(into: Spherical): void {
    into.setFromVector3(this.offsetM.copy(this.controls.object.position).sub(this.controls.target));
  }
}

// The camera views, the moves between them, and the view that follows a boat.
import { MOUSE, Spherical, TOUCH, Vector3, type PerspectiveCamera } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

import { clamp, smooth, wrapAngle } from "../maths/interpolate";
import { CameraHand } from "./camera_hand";
import { diveView, keepClear, type DiveWater } from "./dive";
import { firstView, focusBox, frameBox, freeTangents, raisedBy, raisedTo, turnedTo, type PixelRect, type Placement, type ViewedBox } from "./framing";

export type ViewName = "start" | "side" | "boat" | "overview" | "below";
type FixedView = Exclude<ViewName, "boat">;

/** Direction from the water to the camera. The distance follows from the box to be seen. */
const kBackward: Record<Exclude<FixedView, "below">, Vector3> = {
  start: new Vector3(0.43, 0.50, 1.22),
  side: new Vector3(0.20, 0.13, 1.30),
  overview: new Vector3(-0.30, 1.25, 0.80),
};
/** Where the view from below looks: toward the noon sun, with the edge of Snell's window in the picture. */
const kBelowAhead = new Vector3(-0.42, 0.24, -0.88).normalize();
/** Height of the picture as an angle; from below wide, for the window and the floor. */
const kFovDegrees = 47;
const kBelowFovDegrees = 72;
/** Least angle between the line of sight and straight down, and straight up in water; between it and the level above the water only. */
const kSteepestRad = 0.12;
const kLowestRad = 0.03;
const kTravelS = 0.9;
/** A part of the water is shown from at least so high: from as low as many first views, boats hide one another. */
const kFramedPitchRad = 0.45;
/** The boat's view: distance behind and above in boat lengths, and the rates at which it follows position, heading and camera position. */
const kBehindLengths = 2.5;
const kAboveLengths = 1.05;
const kFollowPerS = { target: 7, heading: 2.2, eye: 3.2 };

/** Longest time step of the follow motion; a hidden page comes back with a long one. */
const kLongestFrameS = 2;

/** The boat that the boat's view follows. */
export interface Followed {
  xM: number;
  yM: number;
  zM: number;
  headingRad: number;
  lengthM: number;
}

function fovOf(view: ViewName | undefined): number {
  return view === "below" ? kBelowFovDegrees : kFovDegrees;
}

export class CameraViews {
  /** Called when the user has left a view by moving the camera. */
  left: () => void = () => {};
  private readonly controls: OrbitControls;
  private readonly hand: CameraHand;
  /** Undefined: the camera stays above the still water. */
  private water: DiveWater | undefined;
  private extent: ViewedBox = { sideM: 16, minYM: -1, maxYM: 1 };
  private free: PixelRect = { leftPx: 0, topPx: 0, rightPx: 1, bottomPx: 1 };
  private widthPx = 1;
  private heightPx = 1;
  /** The view shown or travelled to; undefined after the user moved the camera. */
  private framed: ViewName | undefined = "start";
  /** In the boat's view: the smoothed heading, and whether the user has turned the camera since. */
  private following: { headingRad: number; byHand: boolean; lastS: number } | undefined;
  private readonly scratchM = new Vector3();
  private travel: { fromM: Vector3; toM: Vector3; fromTargetM: Vector3; toTargetM: Vector3; fromFovDegrees: number; startedS: number } | undefined;

  /** Called when keys or a gamepad turn the view. */
  turned: () => void = () => {};

  constructor(
    private readonly camera: PerspectiveCamera,
    canvas: HTMLElement,
    private readonly reducedMotion: () => boolean,
  ) {
    this.controls = new OrbitControls(camera, canvas);
    this.controls.enablePan = false;
    this.controls.enableDamping = !reducedMotion();
    this.controls.dampingFactor = 0.09;
    this.controls.minPolarAngle = kSteepestRad;
    this.controls.listenToKeyEvents(canvas);
    this.controls.mouseButtons = { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.ROTATE };
    this.controls.touches = { ONE: TOUCH.ROTATE, TWO: TOUCH.DOLLY_ROTATE };
    this.hand = new CameraHand(this.controls, () => this.movedByHand());
  }

  /** New water: back to the first view. `water` undefined: it is not deep enough for a camera. */
  enter(extent: ViewedBox, water: DiveWater | undefined): void {
    this.extent = extent;
    this.water = water;
    this.controls.maxPolarAngle = water ? Math.PI - kSteepestRad : Math.PI / 2 - kLowestRad;
    this.jump("start");
  }

  /** Takes the water's height once it is known. Frames the box again unless the user has turned the camera. */
  measured(extent: ViewedBox): void {
    this.extent = extent;
    this.frameAgain();
  }

  /**
   * Sets the size of the canvas in CSS pixels and the part that the panels leave free. The picture is centred in that part, and the
   * box is framed again unless the user has turned the camera.
   */
  resize(widthPx: number, heightPx: number, free: PixelRect): void {
    const { camera } = this;
    camera.aspect = widthPx / Math.max(heightPx, 1);
    const rightwardPx = (free.leftPx + free.rightPx - widthPx) / 2;
    const downwardPx = (free.topPx + free.bottomPx - heightPx) / 2;
    camera.setViewOffset(widthPx, heightPx, -rightwardPx, -downwardPx, widthPx, heightPx);
    const same = widthPx === this.widthPx && heightPx === this.heightPx && Object.entries(free).every(([edge, px]) => this.free[edge as keyof PixelRect] === px);
    this.widthPx = widthPx;
    this.heightPx = Math.max(heightPx, 1);
    this.free = free;
    if (!same) this.frameAgain();
  }

  /** False: a pointer that is pressed now does not turn the camera. */
  set takesPointers(takes: boolean) {
    this.controls.enabled = takes;
  }

  /** What the camera looks at. */
  get targetM(): Vector3 {
    return this.controls.target.clone();
  }

  get canDive(): boolean {
    return this.water !== undefined;
  }

  get view(): ViewName | undefined {
    return this.framed;
  }

  go(name: ViewName, nowS: number): void {
    this.hand.release();
    if (name === "boat") {
      this.framed = name;
      this.setFov(fovOf(name));
      this.travel = undefined;
      this.following = { headingRad: Number.NaN, byHand: false, lastS: nowS };
      return;
    }
    this.following = undefined;
    if (this.reducedMotion()) return this.jump(name);
    const { positionM, targetM } = this.placed(name);
    this.framed = name;
    this.travel = {
      fromFovDegrees: this.camera.fov,
      fromM: this.camera.position.clone(),
      toM: positionM,
      fromTargetM: this.controls.target.clone(),
      toTargetM: targetM,
      startedS: nowS,
    };
  }

  /** Leaves the view for another position of the camera, which may be nearer than the user can go. */
  place(eyeM: readonly [number, number, number], targetM: readonly [number, number, number]): void {
    this.framed = this.following = this.travel = undefined;
    this.controls.minDistance = 0;
    this.camera.position.set(...eyeM);
    this.controls.target.set(...targetM);
    this.hand.release();
    this.hand.update();
  }

  /** Moves the camera round what it looks at, to the right and down, and multiplies its distance: as a key or a gamepad does. */
  orbit(rightRad: number, downRad: number, distanceRatio: number): void {
    const { camera, controls, scratchM } = this;
    const around = new Spherical().setFromVector3(scratchM.copy(camera.position).sub(controls.target));
    around.theta += rightRad;
    around.phi = clamp(around.phi + downRad, controls.minPolarAngle, controls.maxPolarAngle);
    around.radius = clamp(around.radius * distanceRatio, controls.minDistance, controls.maxDistance);
    camera.position.setFromSpherical(around).add(controls.target);
    this.movedByHand();
    this.hand.update();
    this.turned();
  }

  /** Returns where the camera shows a disc of the water, from the side of the first view. */
  frame({ xM, zM, radiusM }: { xM: number; zM: number; radiusM: number }): Placement {
    const tangents = freeTangents(kFovDegrees, this.heightPx, this.widthPx, this.free);
    const { sideM, widthM = sideM, minYM, maxYM } = this.extent;
    const within = (atM: number, outM: number): number => clamp(atM, -Math.max(outM, 0), Math.max(outM, 0));
    const box = {
      sideM: Math.min(2 * radiusM, sideM),
      widthM: Math.min(2 * radiusM, widthM),
      centreM: { x: within(xM, sideM / 2 - radiusM), z: within(zM, widthM / 2 - radiusM) },
      // The bed does not matter for a part of the water.
      minYM: Math.max(minYM, -0.25 * radiusM),
      maxYM,
    };
    return frameBox(box, raisedTo(kFramedPitchRad, this.aimed("start", tangents).backward), tangents);
  }

  /** Returns where the first view is, and lets the user come as near as there. */
  firstPlacement(): Placement {
    return this.placed("start");
  }

  /** `followed`: the boat of the boat's view; without one the camera does not move. */
  update(nowS: number, followed?: Followed): void {
    if (this.following && followed) this.follow(this.following, followed, nowS);
    if (this.travel) {
      const done = Math.min((nowS - this.travel.startedS) / kTravelS, 1);
      const eased = smooth(done);
      this.camera.position.lerpVectors(this.travel.fromM, this.travel.toM, eased);
      this.controls.target.lerpVectors(this.travel.fromTargetM, this.travel.toTargetM, eased);
      this.setFov(this.travel.fromFovDegrees + (fovOf(this.framed) - this.travel.fromFovDegrees) * eased);
      if (done >= 1) this.travel = undefined;
    }
    this.hand.update();
    if (this.water && !this.travel && keepClear(this.water, this.camera.position)) {
      this.camera.lookAt(this.controls.target);
      this.hand.placed();
    }
  }

  /** The boat's view continues following the boat, from where the user looks at it. */
  private movedByHand(): void {
    if (this.following) {
      this.following.byHand = true;
      return;
    }
    if (!this.framed) return;
    this.framed = this.travel = undefined;
    this.left();
  }

  private follow(following: NonNullable<CameraViews["following"]>, boat: Followed, nowS: number): void {
    const { camera, controls, scratchM } = this;
    const elapsedS = clamp(nowS - following.lastS, 0, kLongestFrameS);
    following.lastS = nowS;
    const still = this.reducedMotion();
    const share = (perS: number): number => (still ? 1 : 1 - Math.exp(-perS * elapsedS));
    if (Number.isNaN(following.headingRad)) following.headingRad = boat.headingRad;
    const turnRad = wrapAngle(boat.headingRad - following.headingRad) * share(kFollowPerS.heading);
    following.headingRad += turnRad;
    controls.minDistance = boat.lengthM;
    // Camera position relative to the boat, before the boat moves.
    const offsetM = scratchM.copy(camera.position).sub(controls.target);
    const follow = share(kFollowPerS.target);
    const { target } = controls;
    target.set(
      target.x + (boat.xM - target.x) * follow,
      target.y + (boat.yM + 0.25 * boat.lengthM - target.y) * follow,
      target.z + (boat.zM - target.z) * follow,
    );
    if (following.byHand) {
      const [c, s] = [Math.cos(turnRad), Math.sin(turnRad)];
      camera.position.set(target.x + offsetM.x * c - offsetM.z * s, target.y + offsetM.y, target.z + offsetM.x * s + offsetM.z * c);
      return;
    }
    const behindM = kBehindLengths * boat.lengthM * Math.max(1, 1.15 / Math.max(camera.aspect, 0.6));
    scratchM.set(
      target.x - behindM * Math.cos(following.headingRad),
      target.y + kAboveLengths * boat.lengthM,
      target.z - behindM * Math.sin(following.headingRad),
    );
    camera.position.lerp(scratchM, share(kFollowPerS.eye));
  }

  /** Frames the current view again for another canvas or other water. */
  private frameAgain(): void {
    if (this.framed && this.framed !== "boat") this.jump(this.framed);
  }

  private jump(name: FixedView): void {
    this.following = undefined;
    const { positionM, targetM } = this.placed(name);
    this.framed = name;
    this.travel = undefined;
    this.camera.position.copy(positionM);
    this.controls.target.copy(targetM);
    this.setFov(fovOf(name));
    this.hand.release();
    this.hand.update();
  }

  private setFov(degrees: number): void {
    if (degrees === this.camera.fov) return;
    this.camera.fov = degrees;
    this.camera.updateProjectionMatrix();
  }

  /** Returns the part of the water that a view shows, and the direction to the camera. */
  private aimed(name: Exclude<FixedView, "below">, tangents: { across: number; up: number }): { box: ViewedBox; backward: Vector3 } {
    const { extent } = this;
    if (name === "start" && extent.first) return firstView(extent, extent.first, tangents);
    const backward = name === "side" ? turnedTo(extent.seenFrom ?? "+z", kBackward.side) : kBackward[name].clone();
    if (name === "start") backward.y *= raisedBy(extent, tangents);
    if (name === "side") backward.y *= extent.sideRaised ?? 1;
    return { box: focusBox(extent, tangents), backward };
  }

  private placed(name: FixedView): Placement {
    const { extent, water } = this;
    if (name === "below" && water) {
      this.controls.minDistance = water.nearM;
      return diveView(water, kBelowAhead);
    }
    if (name === "below") return this.placed("start");
    const tangents = freeTangents(kFovDegrees, this.heightPx, this.widthPx, this.free);
    const { box, backward } = this.aimed(name, tangents);
    const placement = frameBox(box, backward, tangents);
    const distanceM = placement.positionM.distanceTo(placement.targetM);
    // A scene's first view may be nearer.
    this.controls.minDistance = Math.min(0.25 * extent.sideM, 0.5 * distanceM);
    this.controls.maxDistance = Math.max(4 * extent.sideM, 1.5 * distanceM);
    return placement;
  }
}

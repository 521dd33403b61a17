// Where the camera stands for each effect, and the way there.
import { Vector3, type PerspectiveCamera } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

import { frameBox, freeTangents, type PixelRect, type Placement, type WaterExtent } from "./framing";

export type ViewName = "splash" | "wave";

/** From the water toward the camera; how far away it stands follows from what has to be seen. */
const kBackward: Record<ViewName, Vector3> = {
  splash: new Vector3(0.43, 0.50, 1.22),
  wave: new Vector3(0.20, 0.13, 1.30),
};
/** Free parts less wide than this many heights raise the view from above, up to so many times its height. */
const kWideTangents = 1.3;
const kMostRaised = 2.6;
const kTravelS = 0.9;
export class CameraViews {
  readonly controls: OrbitControls;
  private extent: WaterExtent = { sideM: 16, minYM: -1, maxYM: 1 };
  private free: PixelRect = { leftPx: 0, topPx: 0, rightPx: 1, bottomPx: 1 };
  private widthPx = 1;
  private heightPx = 1;
  /** The view that the camera stands in or travels to; none after somebody turned it by hand. */
  private framed: ViewName | undefined = "splash";
  private travel: { fromM: Vector3; toM: Vector3; fromTargetM: Vector3; toTargetM: Vector3; startedS: number } | undefined;

  constructor(
    private readonly camera: PerspectiveCamera,
    canvas: HTMLElement,
    private readonly reducedMotion: () => boolean,
  ) {
    this.controls = new OrbitControls(camera, canvas);
    this.controls.enablePan = false;
    this.controls.enableDamping = !reducedMotion();
    this.controls.dampingFactor = 0.09;
    this.controls.minPolarAngle = 0.12;
    // Just above the level of the still water: the page has no under-water view.
    this.controls.maxPolarAngle = Math.PI / 2 - 0.03;
    this.controls.listenToKeyEvents(canvas);
    this.controls.addEventListener("start", () => (this.framed = this.travel = undefined));
  }

  /** Other water: back to the first view. */
  enter(extent: WaterExtent): void {
    this.extent = extent;
    this.jump("splash");
  }

  /** The water turned out to be of another height; a view that nobody has left yet follows. */
  measured(extent: WaterExtent): void {
    this.extent = extent;
    if (this.framed) this.jump(this.framed);
  }

  /**
   * A canvas of this size in CSS pixels, of which the panels leave `free`: the picture is centred there, and a view that
   * nobody has left yet is framed anew.
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
    if (!same && this.framed) this.jump(this.framed);
  }

  go(name: ViewName, nowS: number): void {
    if (this.reducedMotion()) return this.jump(name);
    const { positionM, targetM } = this.placed(name);
    this.framed = name;
    this.travel = {
      fromM: this.camera.position.clone(),
      toM: positionM,
      fromTargetM: this.controls.target.clone(),
      toTargetM: targetM,
      startedS: nowS,
    };
  }

  update(nowS: number): void {
    if (this.travel) {
      const done = Math.min((nowS - this.travel.startedS) / kTravelS, 1);
      const eased = done * done * (3 - 2 * done);
      this.camera.position.lerpVectors(this.travel.fromM, this.travel.toM, eased);
      this.controls.target.lerpVectors(this.travel.fromTargetM, this.travel.toTargetM, eased);
      if (done >= 1) this.travel = undefined;
    }
    this.controls.update();
  }

  dispose(): void {
    this.controls.dispose();
  }

  private jump(name: ViewName): void {
    const { positionM, targetM } = this.placed(name);
    this.framed = name;
    this.travel = undefined;
    this.camera.position.copy(positionM);
    this.controls.target.copy(targetM);
    this.controls.update();
  }

  private placed(name: ViewName): Placement {
    const { extent, camera } = this;
    const tangents = freeTangents(camera.fov, this.heightPx, this.widthPx, this.free);
    const backward = kBackward[name].clone();
    // A tall free part shows the square from further above, which fills more of it.
    if (name === "splash") backward.y *= Math.min(Math.max((kWideTangents * tangents.up) / tangents.across, 1), kMostRaised);
    const placement = frameBox(extent, backward, tangents);
    const distanceM = placement.positionM.distanceTo(placement.targetM);
    this.controls.minDistance = 0.25 * extent.sideM;
    this.controls.maxDistance = Math.max(4 * extent.sideM, 1.5 * distanceM);
    return placement;
  }
}

// Where the camera stands for each effect, and the way there.
import { Vector3, type PerspectiveCamera } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

export type ViewName = "splash" | "wave";

/** In sides of the water; the whole square fits a landscape screen. */
const kViews: Record<ViewName, { position: Vector3; target: Vector3 }> = {
  splash: { position: new Vector3(0.43, 0.46, 1.22), target: new Vector3(0, -0.035, 0) },
  wave: { position: new Vector3(0.20, 0.12, 1.30), target: new Vector3(0, 0.02, 0) },
};
const kTravelS = 0.9;
/** Screens narrower than this have the camera further back. */
const kFullAspect = 1.5;

export class CameraViews {
  readonly controls: OrbitControls;
  private sideM = 16;
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
    this.controls.addEventListener("start", () => (this.travel = undefined));
  }

  enter(sideM: number): void {
    this.sideM = sideM;
    this.controls.minDistance = 0.25 * sideM;
    this.controls.maxDistance = 4 * sideM;
    this.jump("splash");
  }

  go(name: ViewName, nowS: number): void {
    if (this.reducedMotion()) return this.jump(name);
    const { positionM, targetM } = this.placed(name);
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
    this.travel = undefined;
    this.camera.position.copy(positionM);
    this.controls.target.copy(targetM);
    this.controls.update();
  }

  private placed(name: ViewName): { positionM: Vector3; targetM: Vector3 } {
    const view = kViews[name];
    const back = Math.min(Math.max(kFullAspect / this.camera.aspect, 1), 2.1);
    return {
      positionM: view.position.clone().multiplyScalar(this.sideM * back),
      targetM: view.target.clone().multiplyScalar(this.sideM),
    };
  }
}

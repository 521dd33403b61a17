// When a camera view ends: the controls of three.js with a canvas that only has events.
import { PerspectiveCamera } from "three";
import { beforeEach, describe, expect, it } from "vitest";

import { CameraViews, type Followed } from "../src/scene/camera/camera_views";

const kHeightPx = 600;
const kBoat: Followed = { xM: 3, yM: 0, zM: -2, headingRad: 0.4, lengthM: 2 };

/** The part of an element that the controls use. */
class FakeCanvas extends EventTarget {
  readonly style = {};
  readonly clientWidth = 900;
  readonly clientHeight = kHeightPx;
  readonly ownerDocument = new EventTarget();
  setPointerCapture(): void {}
  releasePointerCapture(): void {}
  getRootNode(): EventTarget {
    return this.ownerDocument;
  }
}

let canvas: FakeCanvas;
let camera: PerspectiveCamera;
let views: CameraViews;
let nowS: number;
let leftCount: number;

/** `isStill`: without damping and moves between views. */
function makeViews(isStill: boolean): void {
  canvas = new FakeCanvas();
  camera = new PerspectiveCamera(47, 1.5, 0.05, 200);
  views = new CameraViews(camera, canvas as unknown as HTMLElement, () => isStill);
  views.resize(900, kHeightPx, { leftPx: 0, topPx: 0, rightPx: 900, bottomPx: kHeightPx });
  views.enter({ sideM: 16, minYM: -1, maxYM: 1 }, undefined);
  nowS = 0;
  leftCount = 0;
  views.left = () => ++leftCount;
}

function pictures(count: number, followed?: Followed): void {
  for (let i = 0; i < count; ++i) views.update((nowS += 1 / 60), followed);
}

function pointer(type: "pointerdown" | "pointermove" | "pointerup", xPx: number, yPx: number): void {
  const event = Object.assign(new Event(type), { pointerId: 1, pointerType: "mouse", button: 0, clientX: xPx, clientY: yPx, pageX: xPx, pageY: yPx });
  (type === "pointerdown" ? canvas : canvas.ownerDocument).dispatchEvent(event);
}

/** Presses at (400, 300), moves by `byPx` and releases, with pictures between. */
function drag(byPx: readonly [number, number], followed?: Followed): void {
  pointer("pointerdown", 400, 300);
  pictures(2, followed);
  pointer("pointermove", 400 + byPx[0], 300 + byPx[1]);
  pictures(2, followed);
  pointer("pointerup", 400 + byPx[0], 300 + byPx[1]);
  pictures(60, followed);
}

describe.each([true, false])("a view, with reduced motion %s", (isStill) => {
  beforeEach(() => makeViews(isStill));

  it("stays after a click, also of an unsteady hand", () => {
    drag([0, 0]);
    expect(views.view).toBe("start");
    drag([4, -3]);
    expect(views.view).toBe("start");
    expect(leftCount).toBe(0);
  });

  it("ends once after a drag", () => {
    drag([60, 10]);
    expect(views.view).toBeUndefined();
    expect(leftCount).toBe(1);
  });

  it("ends after a step of the wheel, and after keys that turn the camera", () => {
    canvas.dispatchEvent(Object.assign(new Event("wheel"), { deltaY: 100, deltaMode: 0, clientX: 400, clientY: 300, ctrlKey: false }));
    expect(views.view).toBeUndefined();
    makeViews(isStill);
    for (let i = 0; i < 30; ++i) canvas.dispatchEvent(Object.assign(new Event("keydown"), { code: "ArrowLeft", shiftKey: true }));
    pictures(60);
    expect(views.view).toBeUndefined();
  });

  it("ends when a gamepad or a key moves the camera, within the bounds of the controls", () => {
    pictures(2);
    const { x, y, z } = camera.position;
    const distanceM = Math.hypot(x, y, z);
    views.orbit(0.2, 0, 0.9);
    expect(leftCount).toBe(1);
    expect(Math.hypot(x - camera.position.x, z - camera.position.z)).toBeGreaterThan(0.05 * distanceM);
    views.orbit(0, -10, 1e6);
    views.orbit(0, 10, 1);
    pictures(2);
    // Above what it looks at, which is in the water.
    expect(camera.position.y).toBeGreaterThan(-1);
    expect(Math.hypot(...camera.position.toArray())).toBeLessThan(100 * distanceM);
  });

  it("stays while the page moves the camera: a click on the way to a view", () => {
    for (const name of ["side", "overview", "start"] as const) {
      views.go(name, nowS);
      pictures(5);
      drag([0, 0]);
      pictures(60);
      expect(views.view).toBe(name);
    }
  });

  it("follows a boat and stays where a drag turned it", () => {
    views.go("boat", nowS);
    pictures(600, kBoat);
    const behind = camera.position.clone();
    views.go("start", nowS);
    pictures(120);
    views.go("boat", nowS);
    drag([0, 0], kBoat);
    pictures(600, kBoat);
    expect(views.view).toBe("boat");
    expect(camera.position.distanceTo(behind)).toBeLessThan(0.05);
    drag([150, 0], kBoat);
    pictures(600, kBoat);
    expect(views.view).toBe("boat");
    expect(camera.position.distanceTo(behind)).toBeGreaterThan(1);
  });
});

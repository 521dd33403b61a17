import { PerspectiveCamera, Vector3 } from "three";
import { describe, expect, it } from "vitest";

import { elevationAtM, elevationRangeM } from "../src/scene/frames/height_field";
import { pickWater, type WaterShape } from "../src/scene/frames/pick";
import { waterInMiddle, waterUnder } from "../src/app/pointer_ray";
import type { Display } from "../src/app/display";
import { TapDetector } from "../src/ui/tap";
import type { WaterPlace } from "../src/ui/tools";

const flat: WaterShape = { sideM: 16, widthM: 16, minM: 0, maxM: 0, elevationAtM: () => 0 };

/** The page with a canvas of 800 x 600 px, of which a panel covers the right fourth. */
function display(camera: PerspectiveCamera, water?: WaterShape): Display {
  const canvas = { getBoundingClientRect: () => ({ left: 0, top: 0, width: 800, height: 600 }) };
  return { canvas, scene: { camera, shape: () => water }, freePart: { leftPx: 0, topPx: 0, rightPx: 600, bottomPx: 600 } } as unknown as Display;
}

function camera(): PerspectiveCamera {
  const made = new PerspectiveCamera(47, 800 / 600, 0.1, 700);
  made.position.set(6, 7, 18);
  made.lookAt(0, 0, 0);
  made.updateMatrixWorld();
  return made;
}

describe("a click on the water", () => {
  it("hits the point under the pixel", () => {
    const eye = camera();
    for (const [xM, zM] of [[0, 0], [3, -2], [-5, 4]] as const) {
      const seen = new Vector3(xM, 0, zM).project(eye);
      const place = waterUnder(display(eye, flat), (seen.x + 1) * 400, (1 - seen.y) * 300)!;
      expect(place.xM).toBeCloseTo(xM, 4);
      expect(place.zM).toBeCloseTo(zM, 4);
    }
  });

  it("hits the crest in front, not the plane behind it", () => {
    const crest: WaterShape = { sideM: 16, widthM: 16, minM: 0, maxM: 1, elevationAtM: (_, zM) => Math.exp(-((zM - 2) ** 2)) };
    const eye = camera();
    const seen = new Vector3(0, Math.exp(-0.04), 2.2).project(eye);
    const place = waterUnder(display(eye, crest), (seen.x + 1) * 400, (1 - seen.y) * 300)!;
    expect(place.zM).toBeCloseTo(2.2, 2);
    expect(place.xM).toBeCloseTo(0, 2);
  });

  it("misses beside the water, above the horizon and behind the camera", () => {
    expect(pickWater({ originM: [0, 5, 0], direction: [0.98, -0.2, 0] }, flat)).toBeUndefined();
    expect(pickWater({ originM: [0, 5, 0], direction: [0, 0.6, 0.8] }, flat)).toBeUndefined();
    expect(pickWater({ originM: [0, -5, 0], direction: [0, -1, 0] }, flat)).toBeUndefined();
  });

  it("picks the water behind a pane of a tank, not above its surface, below its floor or beside it", () => {
    const tank: WaterShape = { sideM: 2, widthM: 1, minM: 0, maxM: 0, glassFromM: -0.5, elevationAtM: () => 0 };
    const ahead = (xM: number, yM: number): ReturnType<typeof pickWater> => pickWater({ originM: [xM, yM, 3], direction: [0, 0, -1] }, tank);
    expect(ahead(0.4, -0.2)).toEqual({ xM: 0.4, zM: 0.5 });
    expect([ahead(0.4, 0.1), ahead(0.4, -0.6), ahead(1.1, -0.2)]).toEqual([undefined, undefined, undefined]);
    expect(pickWater({ originM: [3, -1, 0], direction: [-0.96, 0.28, 0] }, tank)).toEqual({ xM: 1, zM: 0 });
    expect(pickWater({ originM: [0.4, -0.2, 3], direction: [0, 0, 1] }, tank)).toBeUndefined();
    expect(pickWater({ originM: [0.4, -0.2, 3], direction: [0, 0, -1] }, { ...tank, glassFromM: undefined })).toBeUndefined();
  });
});

describe("the water in the middle of the picture", () => {
  const pixelOf = (eye: PerspectiveCamera, { xM, zM }: WaterPlace): [number, number] => {
    const seen = new Vector3(xM, 0, zM).project(eye);
    return [(seen.x + 1) * 400, (1 - seen.y) * 300];
  };

  it("is where the free part has its middle, or below it where that shows the sky", () => {
    const eye = camera();
    const [atX, atY] = pixelOf(eye, waterInMiddle(display(eye, flat))!);
    expect([atX, atY]).toEqual([expect.closeTo(300, 3), expect.closeTo(300, 3)]);
    eye.lookAt(0, 6, 0);
    eye.updateMatrixWorld();
    const [, lowerY] = pixelOf(eye, waterInMiddle(display(eye, flat))!);
    expect(lowerY).toBeCloseTo(480, 3);
  });

  it("is nowhere where none is seen", () => {
    const eye = camera();
    eye.lookAt(6, 20, 0);
    eye.updateMatrixWorld();
    expect(waterInMiddle(display(eye, flat))).toBeUndefined();
    expect(waterInMiddle(display(eye))).toBeUndefined();
  });
});

describe("the CPU's view of the surface", () => {
  const n = 4;
  const values = Int16Array.from({ length: n * n }, (_, at) => 100 * (at % n) + 10 * Math.floor(at / n));
  const frame = { layer: "surface" as const, tick: 1n, stateId: 0n, timeS: 0, serverTimeS: 0, level: "full" as const, resolutionCount: n, countZ: n, sideM: 8, widthM: 8, quantumM: 0.01, buffer: values.buffer };

  it("interpolates between samples and clamps at the edge", () => {
    expect(elevationAtM(frame, -3, -3)).toBeCloseTo(0, 9);
    expect(elevationAtM(frame, -2, -3)).toBeCloseTo(0.5, 9);
    expect(elevationAtM(frame, 1, 1)).toBeCloseTo(2.2, 9);
    expect(elevationAtM(frame, 0, 0)).toBeCloseTo(1.65, 9);
    expect(elevationAtM(frame, 100, 100)).toBeCloseTo(3.3, 9);
    expect(elevationAtM(frame, -100, -100)).toBeCloseTo(0, 9);
  });

  it("has the minimum and maximum of the samples", () => {
    const range = elevationRangeM(frame);
    expect(range.minM).toBe(0);
    expect(range.maxM).toBeCloseTo(3.3, 9);
  });
});

describe("a tap", () => {
  const at = (id: number, xPx: number, yPx: number, timeMs: number) => ({ id, xPx, yPx, timeMs });

  it("is a short press without movement", () => {
    const taps = new TapDetector();
    taps.pressed(at(1, 10, 10, 0));
    expect(taps.released(at(1, 13, 12, 200))).toBe(true);
  });

  it("is not a drag, a long press or a second finger", () => {
    const taps = new TapDetector();
    taps.pressed(at(1, 10, 10, 0));
    expect(taps.released(at(1, 30, 10, 200))).toBe(false);
    taps.pressed(at(1, 10, 10, 0));
    expect(taps.released(at(1, 10, 10, 2000))).toBe(false);
    taps.pressed(at(1, 10, 10, 0));
    taps.pressed(at(2, 50, 50, 10));
    expect(taps.released(at(2, 50, 50, 100))).toBe(false);
    expect(taps.released(at(1, 10, 10, 100))).toBe(false);
    taps.pressed(at(3, 10, 10, 0));
    expect(taps.released(at(3, 10, 10, 100))).toBe(true);
  });
});

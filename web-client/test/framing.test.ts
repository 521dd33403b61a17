import { PerspectiveCamera, Vector3 } from "three";
import { describe, expect, it } from "vitest";

import { firstView, focusBox, frameBox, freeTangents, raisedBy, raisedTo, turnedTo, type PixelRect, type ViewedBox } from "../src/scene/camera/framing";

const backwards = [new Vector3(0.43, 0.5, 1.22), new Vector3(0.2, 0.13, 1.3), new Vector3(-1, 2, 0.1)];
const waters: ViewedBox[] = [
  { sideM: 24, minYM: -1.5, maxYM: 1 },
  { sideM: 100, minYM: -3, maxYM: 4 },
  { sideM: 2.4, minYM: 0, maxYM: 1.6 },
  { sideM: 2.4, minYM: -0.6, maxYM: 0.1 },
];
const screens: { widthPx: number; heightPx: number; free: PixelRect }[] = [
  { widthPx: 1280, heightPx: 800, free: { leftPx: 0, topPx: 115, rightPx: 992, bottomPx: 800 } },
  { widthPx: 900, heightPx: 600, free: { leftPx: 0, topPx: 110, rightPx: 574, bottomPx: 600 } },
  { widthPx: 390, heightPx: 844, free: { leftPx: 0, topPx: 90, rightPx: 390, bottomPx: 420 } },
  { widthPx: 2560, heightPx: 700, free: { leftPx: 0, topPx: 0, rightPx: 2560, bottomPx: 700 } },
];

/** The eight corners of the water in pixels, as a camera set up like the page's sees them. */
function cornersPx(water: ViewedBox, backward: Vector3, screen: (typeof screens)[number]): { xPx: number; yPx: number }[] {
  const { widthPx, heightPx, free } = screen;
  const camera = new PerspectiveCamera(47, widthPx / heightPx, 0.1, 1000);
  camera.setViewOffset(widthPx, heightPx, (widthPx - free.leftPx - free.rightPx) / 2, (heightPx - free.topPx - free.bottomPx) / 2, widthPx, heightPx);
  const { positionM, targetM } = frameBox(water, backward, freeTangents(47, heightPx, widthPx, free));
  camera.position.copy(positionM);
  camera.lookAt(targetM);
  camera.updateMatrixWorld();
  const corners = [];
  for (const x of [-0.5, 0.5])
    for (const z of [-0.5, 0.5])
      for (const y of [water.minYM, water.maxYM]) {
        const seen = new Vector3(x * water.sideM, y, z * water.sideM).project(camera);
        corners.push({ xPx: ((seen.x + 1) / 2) * widthPx, yPx: ((1 - seen.y) / 2) * heightPx });
      }
  return corners;
}

describe("a view of the water", () => {
  it("shows every corner and fills the free part", () => {
    for (const water of waters)
      for (const backward of backwards)
        for (const screen of screens) {
          const { free } = screen;
          const xs = cornersPx(water, backward, screen).map(({ xPx }) => xPx);
          const ys = cornersPx(water, backward, screen).map(({ yPx }) => yPx);
          const slack = {
            left: Math.min(...xs) - free.leftPx,
            right: free.rightPx - Math.max(...xs),
            top: Math.min(...ys) - free.topPx,
            bottom: free.bottomPx - Math.max(...ys),
          };
          for (const px of Object.values(slack)) expect(px).toBeGreaterThan(1);
          expect(slack.left).toBeCloseTo(slack.right, 3);
          expect(slack.top).toBeCloseTo(slack.bottom, 3);
          const used = Math.max(1 - (slack.left + slack.right) / (free.rightPx - free.leftPx), 1 - (slack.top + slack.bottom) / (free.bottomPx - free.topPx));
          expect(used).toBeCloseTo(0.93, 6);
        }
  });

  it("scales with the water: twice the size from twice the distance", () => {
    const tangents = freeTangents(47, 800, 1280, screens[0]!.free);
    const near = frameBox({ sideM: 10, minYM: -1, maxYM: 1 }, backwards[0]!, tangents);
    const far = frameBox({ sideM: 20, minYM: -2, maxYM: 2 }, backwards[0]!, tangents);
    expect(far.positionM.distanceTo(near.positionM.multiplyScalar(2))).toBeCloseTo(0, 9);
  });

  it("is centred on the box where that is not in the middle of the water", () => {
    const tangents = freeTangents(47, 800, 1280, screens[0]!.free);
    const water = { sideM: 40, minYM: -3, maxYM: 2 };
    const square = frameBox(water, backwards[0]!, tangents);
    const moved = frameBox({ ...water, centreM: { x: 10, z: -5 } }, backwards[0]!, tangents);
    expect(moved.positionM.sub(square.positionM).distanceTo(new Vector3(10, 0, -5))).toBeCloseTo(0, 9);
  });

  it("shows a smaller part the taller the free part is", () => {
    const water = { sideM: 40, minYM: -3, maxYM: 2 };
    expect(focusBox(water, { across: 0.2, up: 0.4 })).toEqual(water);
    const focused = { ...water, focus: { wide: 0.8, tall: 0.5 }, lean: { x: -0.1, z: 0 } };
    let before = 1;
    for (const ratio of [2, 1.1, 0.9, 0.7, 0.5]) {
      const { sideM, centreM } = focusBox(focused, { across: ratio, up: 1 });
      expect(sideM / 40).toBeLessThanOrEqual(before);
      expect(centreM).toEqual({ x: -4, z: 0 });
      before = sideM / 40;
    }
    expect(focusBox(focused, { across: 2, up: 1 }).sideM).toBeCloseTo(32, 9);
    expect(before).toBeCloseTo(0.5, 9);
  });

  it("comes nearer to an open sea than to a tank", () => {
    for (const screen of [screens[0]!, { widthPx: 390, heightPx: 844, free: { leftPx: 0, topPx: 90, rightPx: 390, bottomPx: 844 } }]) {
      const tangents = freeTangents(47, screen.heightPx, screen.widthPx, screen.free);
      const square = { sideM: 32, minYM: -1.2, maxYM: 1.3 };
      const distanceM = (box: ViewedBox): number => {
        const { positionM, targetM } = frameBox(focusBox(box, tangents), backwards[0]!, tangents);
        return positionM.distanceTo(targetM);
      };
      const share = distanceM({ ...square, focus: { wide: 0.72, tall: 0.5 } }) / distanceM(square);
      expect(share).toBeLessThan(screen.widthPx > 1000 ? 0.76 : 0.56);
    }
  });

  it("looks down more steeply in a tall free part", () => {
    const box = { sideM: 10, minYM: 0, maxYM: 1, raised: { wide: 1, tall: 2 } };
    expect(raisedBy(box, { across: 2, up: 1 })).toBe(1);
    expect(raisedBy(box, { across: 0.5, up: 1 })).toBe(2);
    expect(raisedBy(box, { across: 0.9, up: 1 })).toBeCloseTo(1.5, 9);
  });

  it("keeps a finite distance where the panels leave no free part", () => {
    const nothing = freeTangents(47, 600, 300, { leftPx: 300, topPx: 600, rightPx: 300, bottomPx: 600 });
    const { positionM } = frameBox(waters[0]!, backwards[0]!, nothing);
    expect(positionM.length()).toBeGreaterThan(24);
    expect(positionM.length()).toBeLessThan(24 * 20);
  });
});

describe("the first view of a scene", () => {
  const first = { xM: 3, zM: -2, acrossM: 12, awayM: 6, headingRad: 0.7, pitchRad: 0.3, hour: 12, subjectRightM: 2 };
  const water = { sideM: 40, minYM: -1, maxYM: 1 };

  it("looks along its heading and down by its pitch, at its rectangle", () => {
    const { box, backward } = firstView(water, first, { across: 2, up: 1 });
    expect(backward.length()).toBeCloseTo(1, 12);
    expect(Math.asin(backward.y)).toBeCloseTo(0.3, 12);
    expect(Math.atan2(-backward.z, -backward.x)).toBeCloseTo(0.7, 12);
    expect(box).toMatchObject({ sideM: 6, widthM: 12, centreM: { x: 3, z: -2 } });
    // The picture's right is across the heading, so the rectangle's length fills it.
    const { positionM, targetM } = frameBox({ ...box, minYM: 0, maxYM: 0 }, backward, { across: 1, up: 10 });
    const nearestM = new Vector3(3 - 3 * Math.cos(0.7), 0, -2 - 3 * Math.sin(0.7)).sub(positionM).dot(backward.clone().negate());
    expect(nearestM).toBeCloseTo(6, 9);
    expect(targetM.clone().sub(positionM).normalize().distanceTo(backward.clone().negate())).toBeCloseTo(0, 12);
  });

  it("is shorter and steeper in a tall free part, and as wide as the setting where it names no size", () => {
    const tall = firstView(water, first, { across: 0.4, up: 1 });
    expect(tall.box.widthM).toBeLessThan(8);
    // On its subject, 2 m to the right across the heading.
    expect(tall.box.centreM!.x).toBeCloseTo(3 - 2 * Math.sin(0.7), 12);
    expect(tall.box.centreM!.z).toBeCloseTo(-2 + 2 * Math.cos(0.7), 12);
    expect(Math.asin(tall.backward.y)).toBeGreaterThan(0.4);
    expect(firstView(water, { ...first, acrossM: 0, awayM: 0 }, { across: 2, up: 1 }).box).toMatchObject({ sideM: 40, widthM: 40 });
  });
});

describe("a direction to the camera", () => {
  it("looks down by at least an angle, from the same side", () => {
    const low = raisedTo(0.5, new Vector3(3, 0.2, -4));
    expect([low.x, low.z]).toEqual([3, -4]);
    expect(Math.atan2(low.y, 5)).toBeCloseTo(0.5, 9);
    expect(raisedTo(0.5, new Vector3(3, 9, -4))).toEqual(new Vector3(3, 9, -4));
  });

  it("points out of that side, and keeps its length and its share along the side", () => {
    const direction = new Vector3(0.2, 0.13, 1.3);
    expect(turnedTo("+z", direction)).toEqual(direction);
    const outward = { "+x": new Vector3(1, 0, 0), "-x": new Vector3(-1, 0, 0), "-z": new Vector3(0, 0, -1) } as const;
    for (const [side, out] of Object.entries(outward) as [keyof typeof outward, Vector3][]) {
      const turned = turnedTo(side, direction);
      expect(turned.dot(out)).toBeCloseTo(1.3, 12);
      expect(turned.y).toBe(0.13);
      expect(turned.length()).toBeCloseTo(direction.length(), 12);
      // A turn, not a mirror image.
      expect(turned.clone().setY(0).cross(out).y).toBeCloseTo(direction.clone().setY(0).cross(new Vector3(0, 0, 1)).y, 12);
    }
  });
});

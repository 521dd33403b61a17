import { describe, expect, it } from "vitest";

import { makePose } from "../src/scene/frames/bodies";
import { StreamedFrames } from "../src/scene/frames/streamed_frames";
import type { Picture } from "../src/scene/drawing/pass";
import { WaterlinesPass } from "../src/scene/water/waterlines_pass";

const boat = { boatId: 7, lengthM: 4, beamM: 1.5, heightM: 1, draughtM: 0.3 };

function shown(cellM: number, poses: Partial<ReturnType<typeof makePose>>[], boats = [boat]): WaterlinesPass {
  const frames = new StreamedFrames(() => {});
  frames.bodies.push({ timeS: 1, stateId: 0n, bodies: poses.map((pose) => ({ ...makePose(), boatId: 7, ...pose })) });
  const pass = new WaterlinesPass({ boats, gravityMps2: 9.81 }, frames, cellM);
  pass.draw({ shownS: 1 } as Picture);
  return pass;
}

describe("the water against hulls", () => {
  it("stands at the draught over the keel, along the hull's own plane", () => {
    const { count, hulls } = shown(0.1, [{ xM: 3, yM: 0.5, zM: -2, headingRad: Math.PI / 2, pitchRad: 0.1, rollRad: -0.2 }]);
    expect(count.value).toBe(1);
    const [place, size, line] = hulls.value;
    expect(place!.toArray()).toEqual([3, -2, expect.closeTo(0, 9), expect.closeTo(1, 9)]);
    // 0.3 m of draught over the area of the hull, in a shape that is highest in the middle.
    expect(size!.toArray()).toEqual([2, 0.75, expect.closeTo(0.3652, 3), 0.3]);
    expect(line!.toArray()).toEqual([expect.closeTo(0.3, 9), expect.closeTo(Math.tan(0.1), 9), expect.closeTo(Math.tan(0.2), 9), 0]);
  });

  it("rises as far as a hull that is narrower than three cells pressed it down, with the same volume", () => {
    const { hulls } = shown(1, [{}]);
    const size = hulls.value[1]!;
    expect([size.x, size.y]).toEqual([2, 1.5]);
    expect(size.x * size.y * size.z).toBeCloseTo(2 * 0.75 * 0.3652, 3);
  });

  it("has a bow wave that grows with the speed, up to 1.2 draughts", () => {
    const heightM = (speedMps: number): number => shown(0.1, [{ speedMps }]).hulls.value[2]!.w;
    expect(heightM(2)).toBeCloseTo((0.18 * 4) / 19.62, 6);
    expect(heightM(-2)).toBe(heightM(2));
    expect(heightM(20)).toBeCloseTo(0.36, 6);
  });

  it("knows no boats that the room does not have, or does not have any more", () => {
    expect(shown(0.1, [{ boatId: 8 }]).count.value).toBe(0);
    const pass = shown(0.1, [{}, {}]);
    expect(pass.count.value).toBe(2);
    pass.draw({ shownS: undefined } as Picture);
    expect(pass.count.value).toBe(0);
  });

  it("has room for every boat of a room", () => {
    expect(shown(0.1, Array.from({ length: 70 }, () => ({}))).count.value).toBe(64);
  });
});

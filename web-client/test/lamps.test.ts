// Lights in the dark: which are seen from where, and when.
import { BufferGeometry, Group, RawShaderMaterial, Vector3 } from "three";
import { describe, expect, it } from "vitest";

import type { ObstacleInfo } from "../client/codec/scene_info";
import { addBoatLamps, lampShare } from "../src/scene/boats/boat_lamps";
import { kLampsMax, Lamps } from "../src/scene/light/lamps";
import { beamHeadingRad, Landscape } from "../src/scene/landscape/landscape";
import { makeSkerry } from "../src/scene/landscape/skerry";

const boat = { boatId: 1, lengthM: 2.5, beamM: 1, heightM: 0.6, draughtM: 0.2 };

describe("a navigation light", () => {
  it("shows red to port, green to starboard, up to 22.5 degrees abaft the beam", () => {
    for (const bearing of [10, 60, 108]) {
      expect([lampShare("starboard", bearing), lampShare("port", bearing)]).toEqual([1, 0]);
      expect([lampShare("starboard", -bearing), lampShare("port", -bearing)]).toEqual([0, 1]);
    }
    for (const bearing of [117, 180, -180, -117]) expect([lampShare("starboard", bearing), lampShare("port", bearing), lampShare("masthead", bearing), lampShare("stern", bearing)]).toEqual([0, 0, 0, 1]);
  });

  it("shows both side lights from straight ahead, and an all-round light from everywhere", () => {
    expect(lampShare("port", 0)).toBe(lampShare("starboard", 0));
    expect(lampShare("port", 0)).toBeGreaterThan(0.3);
    for (const bearing of [0, 90, 180]) expect(lampShare("allRound", bearing)).toBe(1);
  });

  it("is seen by the boat's heading, and moves with the boat", () => {
    const placed = new Group();
    placed.position.set(10, 0, 5);
    placed.rotation.set(0, -Math.PI / 2, 0, "YZX"); // heading +z: starboard is -x
    placed.updateMatrixWorld();
    const seenFrom = (xM: number, zM: number): number => {
      const lamps = new Lamps();
      addBoatLamps(lamps, boat, placed, [{ at: [1, 0.5, 0], kind: "starboard" }], new Vector3(xM, 1, zM));
      if (lamps.lampsCount) expect(["getX", "getY", "getZ"].map((get) => (lamps.geometry.getAttribute("a_at") as unknown as Record<string, (n: number) => number>)[get]!(0))).toEqual([expect.closeTo(10, 5), 0.5, expect.closeTo(6, 5)]);
      return lamps.lampsCount;
    };
    expect(seenFrom(0, 5)).toBe(1);
    expect(seenFrom(20, 5)).toBe(0);
  });
});

describe("the lamps of a picture", () => {
  it("are bounded, and enough for 64 boats", () => {
    const lamps = new Lamps();
    expect(kLampsMax).toBeGreaterThanOrEqual(64 * 4);
    for (let n = 0; n < 2 * kLampsMax; ++n) lamps.add(n, 0, 0, 1, [1, 1, 1]);
    expect(lamps.lampsCount).toBe(kLampsMax);
    lamps.finish();
    expect(lamps.geometry.instanceCount).toBe(kLampsMax);
    lamps.clear();
    expect(lamps.lampsCount).toBe(0);
  });

  it("hold one lighthouse with two opposite beams, on the longest breakwater, and beacons on the others", () => {
    const walls: ObstacleInfo[] = [6, 14, 9, 14].map((lengthM, n) => ({ shape: "breakwater", xM: 20 * n, zM: 0, lengthM, widthM: 1.2, headingRad: n, heightM: 0.7 }));
    const landscape = new Landscape({ sideM: 80, widthM: 80, depthM: 2, beaches: [] }, new BufferGeometry(), walls, new RawShaderMaterial(), true);
    const lamps = new Lamps();
    landscape.collectLamps(lamps, 2);
    expect(lamps.lampsCount).toBe(4 + 2);
    const reach = lamps.geometry.getAttribute("a_reach");
    const beams = Array.from({ length: 6 }, (_, n) => new Vector3(reach.getX(n), reach.getY(n), reach.getZ(n))).filter((each) => each.length() > 0);
    expect(beams[0]!.clone().add(beams[1]!).length()).toBeCloseTo(0, 5);
    landscape.dispose();
  });

  it.each([false, true])("hold the lighthouse of a sea without land, out of reach of its boats (plain: %s)", (plain) => {
    const landscape = new Landscape({ sideM: 80, widthM: 80, depthM: 2, beaches: [] }, new BufferGeometry(), [], new RawShaderMaterial(), plain, { isLandless: true });
    const lamps = new Lamps();
    landscape.collectLamps(lamps, 2);
    expect(lamps.lampsCount).toBe(1 + 2);
    const { geometry, lampM } = makeSkerry(80, 2, plain);
    expect(lampM.y).toBeGreaterThan(5);
    const { position } = geometry.attributes;
    for (let n = 0; n < position!.count; ++n) expect(Math.hypot(position!.getX(n), position!.getZ(n))).toBeGreaterThan(2 * 80);
    landscape.dispose();
  });
});

it("a lighthouse's beam turns by the scene's time, evenly and for ever", () => {
  const step = beamHeadingRad(1.25) - beamHeadingRad(1);
  expect(step).toBeGreaterThan(0);
  for (const shownS of [0, 3, 1e6]) expect(beamHeadingRad(shownS + 0.25) - beamHeadingRad(shownS)).toBeCloseTo(step, 4);
});

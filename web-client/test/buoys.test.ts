import { describe, expect, it } from "vitest";

import type { ObstacleInfo, SideKind, SideName } from "../client/codec/scene_info";
import { Buoys, buoyPlaces, makeBuoyGeometry, pushedAside } from "../src/scene/boats/buoys";
import { clearanceM } from "../src/scene/landscape/clearance";
import { Lamps } from "../src/scene/light/lamps";
import { depthAtM } from "../src/scene/landscape/terrain";
import { RawShaderMaterial } from "three";

const sides: Record<SideName, SideKind> = { "-x": "open", "+x": "closed", "-z": "open", "+z": "closed" };
const wall = (xM: number, zM: number, lengthM: number, headingDeg: number): ObstacleInfo => ({ shape: "breakwater", xM, zM, lengthM, widthM: 1.2, headingRad: (headingDeg * Math.PI) / 180, heightM: 0.7 });
/** As the scene "harbor". */
const harbor = {
  sideM: 32, widthM: 32,
  waterExtents: { sideM: 32, longM: 32, depthM: 1.2 },
  setting: "openSea" as const,
  wave: { resolutionCount: 192, countZ: 192, sideM: 32, widthM: 32, depthM: 1.2, periodicX: false, periodicZ: false, sides, spongeWidthM: 3, dampingPerS: 0, isNonlinear: true },
  beaches: [{ side: "+x" as const, widthM: 10, shoreDepthM: -0.6 }],
  obstacles: [
    wall(-6, -4, 14, 60), wall(6, -11, 9, 0),
    { shape: "rock" as const, xM: -8, zM: 6, radiusM: 1.3, heightM: 1 }, { shape: "rock" as const, xM: -6.3, zM: 7.6, radiusM: 0.8, heightM: 0.6 }, { shape: "rock" as const, xM: 2.5, zM: 10.5, radiusM: 1.1, heightM: 0.8 },
  ],
};

describe("the places of buoys", () => {
  const places = buoyPlaces(harbor);

  it("are few, the same every time, red and green in turn", () => {
    expect(places.length).toBeGreaterThanOrEqual(2);
    expect(places.length).toBeLessThanOrEqual(8);
    expect(buoyPlaces(harbor)).toEqual(places);
    places.forEach(({ kind }, n) => expect(kind).toBe(n % 2 === 0 ? "red" : "green"));
  });

  it("are in deep water, clear of obstacles, of layers and of each other", () => {
    for (const { xM, zM, radiusM } of places) {
      for (const obstacle of harbor.obstacles) expect(clearanceM(obstacle, xM, zM)).toBeGreaterThan(radiusM);
      expect(depthAtM({ sideM: 32, widthM: 32, depthM: 1.2, beaches: harbor.beaches }, xM, zM)).toBeGreaterThan(0.7);
      expect(Math.min(xM, zM)).toBeGreaterThan(-16 + 3 + radiusM);
      expect(Math.max(xM, zM)).toBeLessThan(16 - radiusM);
      for (const other of places) if (other.xM !== xM || other.zM !== zM) expect(Math.hypot(xM - other.xM, zM - other.zM)).toBeGreaterThan(3);
    }
  });

  it("are left out without room, without breakwaters, in a pool, and without a wave", () => {
    expect(buoyPlaces({ ...harbor, beaches: [{ side: "+x", widthM: 32, shoreDepthM: 0 }, { side: "+z", widthM: 32, shoreDepthM: 0 }], waterExtents: { sideM: 32, longM: 32, depthM: 1.2 }, obstacles: [wall(12, 12, 6, 0)] })).toEqual([]);
    expect(buoyPlaces({ ...harbor, obstacles: harbor.obstacles.slice(2) })).toEqual([]);
    expect(buoyPlaces({ ...harbor, setting: "pool" })).toEqual([]);
    expect(buoyPlaces({ ...harbor, wave: undefined })).toEqual([]);
  });

  it("are bounded in a scene full of breakwaters", () => {
    const many = Array.from({ length: 60 }, (_, n) => wall(-100 + 30 * (n % 8), -100 + 30 * Math.floor(n / 8), 6, 0));
    expect(buoyPlaces({ ...harbor, sideM: 400, widthM: 400, waterExtents: { sideM: 400, longM: 400, depthM: 1.2 }, obstacles: many, beaches: [] })).toHaveLength(8);
  });
});

describe("a buoy in the way of a boat", () => {
  const place = { xM: 0, zM: 0.1, radiusM: 0.2 };
  const boat = (xM: number, headingRad = 0) => ({ xM, zM: 0, headingRad, lengthM: 4, beamM: 1.6 });

  it("stays where it is while the boat is away or beside it", () => {
    expect(pushedAside(place, [])).toEqual([0, 0.1]);
    expect(pushedAside(place, [boat(-2.3), boat(2.3)])).toEqual([0, 0.1]);
    expect(pushedAside({ ...place, zM: 1.1 }, [boat(0)])).toEqual([0, 1.1]);
  });

  it("is pushed to its side of the hull without jumps", () => {
    let [, before] = pushedAside(place, [boat(-3)]);
    let mostM = 0;
    for (let xM = -3; xM <= 3; xM += 0.02) {
      const [x, z] = pushedAside(place, [boat(xM)]);
      expect(x).toBeCloseTo(0, 9);
      expect(z).toBeGreaterThanOrEqual(0.1);
      expect(((x - xM) / 2.2) ** 2 + (z / 1) ** 2).toBeGreaterThan(0.9999);
      expect(Math.abs(z - before)).toBeLessThan(0.15);
      before = z;
      mostM = Math.max(mostM, z);
    }
    expect(mostM).toBeCloseTo(1, 3);
    expect(before).toBe(0.1);
  });

  it("is pushed across the heading of the boat", () => {
    const [x, z] = pushedAside({ xM: -0.1, zM: 0, radiusM: 0.2 }, [{ ...boat(0), headingRad: Math.PI / 2 }]);
    expect(x).toBeCloseTo(-1, 3);
    expect(z).toBeCloseTo(0, 9);
  });
});

describe("a buoy", () => {
  it.each(["red", "green"] as const)("floats upright with finite normals, mostly above the water (%s)", (kind) => {
    const geometry = makeBuoyGeometry({ kind, radiusM: 0.2 }, false);
    geometry.computeBoundingBox();
    const { min, max } = geometry.boundingBox!;
    expect(max.x).toBeCloseTo(0.2, 3);
    expect(min.y).toBeLessThan(-0.15);
    expect(max.y).toBeGreaterThan(0.6);
    const normals = geometry.getAttribute("normal");
    for (let n = 0; n < normals.count; ++n) expect(Math.hypot(normals.getX(n), normals.getY(n), normals.getZ(n))).toBeCloseTo(1, 4);
  });

  it("flashes: shown for a part of each period, and not all at once", () => {
    const buoys = new Buoys(buoyPlaces(harbor), new RawShaderMaterial(), true);
    const counts = Array.from({ length: 60 }, (_, n) => {
      const lamps = new Lamps();
      buoys.collectLamps(lamps, n / 20);
      return lamps.lampsCount;
    });
    expect(Math.max(...counts)).toBeGreaterThan(0);
    expect(Math.min(...counts)).toBeLessThan(buoyPlaces(harbor).length);
    buoys.dispose();
  });
});

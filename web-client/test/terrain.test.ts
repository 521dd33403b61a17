import { Vector3, type BufferGeometry } from "three";
import { describe, expect, it } from "vitest";

import type { BreakwaterInfo, RockInfo } from "../client/codec/scene_info";
import { makeBreakwater } from "../src/scene/landscape/breakwater_mesh";
import { clearanceM } from "../src/scene/landscape/clearance";
import { makeGroundGeometry } from "../src/scene/landscape/landscape";
import { makeLeaves } from "../src/scene/drawing/leaves";
import { makeLace } from "../src/scene/drawing/noise_texture";
import { makeRockGeometry } from "../src/scene/landscape/rock_mesh";
import { MeshBuilder, type Point } from "../src/scene/meshes/mesh_builder";
import { bedUniformValues, depthAtM, groundExtent, groundHeightM, landWidthM, type Bed } from "../src/scene/landscape/terrain";
import { spawnPlace } from "../src/ui/spawn_place";

const bed: Bed = { sideM: 40, widthM: 40, depthM: 3, beaches: [{ side: "-x", widthM: 12, shoreDepthM: 0 }, { side: "+z", widthM: 5, shoreDepthM: 1 }] };
const rock: RockInfo = { shape: "rock", xM: 5, zM: -6, radiusM: 2, heightM: 1.2 };
const wall: BreakwaterInfo = { shape: "breakwater", xM: 1, zM: 2, lengthM: 12, widthM: 2, headingRad: 0.5, heightM: 1 };

function bounds(geometry: BufferGeometry) {
  geometry.computeBoundingBox();
  return geometry.boundingBox!;
}

describe("the bed", () => {
  it("is level away from beaches and rises on a straight line toward their sides", () => {
    expect(depthAtM(bed, 0, 0)).toBe(3);
    expect(depthAtM(bed, -8, 0)).toBeCloseTo(3, 9);
    expect(depthAtM(bed, -14, 0)).toBeCloseTo(1.5, 9);
    expect(depthAtM(bed, -20, 0)).toBeCloseTo(0, 9);
    expect(depthAtM(bed, 5, 20)).toBeCloseTo(1, 9);
    expect(depthAtM(bed, 5, 17.5)).toBeCloseTo(2, 9);
  });

  it("has the smaller depth where two beaches meet", () => {
    expect(depthAtM(bed, -17, 20)).toBeCloseTo(0.75, 9);
    expect(depthAtM(bed, -9, 20)).toBeCloseTo(1, 9);
  });

  it("continues as dry land behind a shore, without a step, and only there", () => {
    expect(landWidthM(bed, bed.beaches[0]!)).toBeGreaterThan(1);
    expect(landWidthM(bed, bed.beaches[1]!)).toBe(0);
    let before = groundHeightM(bed, -19.99, 0);
    for (let xM = -20; xM > -20 - landWidthM(bed, bed.beaches[0]!); xM -= 0.05) {
      const heightM = groundHeightM(bed, xM, 0);
      expect(heightM).toBeGreaterThanOrEqual(before - 1e-9);
      expect(heightM - before).toBeLessThan(0.02);
      before = heightM;
    }
    expect(before).toBeGreaterThan(0.3);
    const extent = groundExtent(bed);
    expect(extent).toMatchObject({ maxXM: 20, minZM: -20, maxZM: 20 });
    expect(extent.minXM).toBeCloseTo(-20 - landWidthM(bed, bed.beaches[0]!), 9);
  });

  it("gives the shaders the same values per side", () => {
    expect(bedUniformValues(bed)).toEqual({ widthsM: [1, 12, 5, 1], shoreDepthsM: [3, 0, 1, 3] });
  });

  it("is drawn from its floor up to its land", () => {
    const { min, max } = bounds(makeGroundGeometry(bed, 24));
    expect(min.y).toBeLessThan(-3);
    expect(min.y).toBeGreaterThan(-3.2);
    expect(max.y).toBeCloseTo(groundHeightM(bed, min.x, 0), 6);
  });
});

describe("an obstacle", () => {
  it("is a rock round its place, from the bed to about its height", () => {
    const { min, max } = bounds(makeRockGeometry(rock, 3));
    expect(min.y).toBeLessThanOrEqual(-3);
    expect(max.y).toBeGreaterThan(0.7 * rock.heightM);
    expect(max.y).toBeLessThan(1.5 * rock.heightM);
    expect((min.x + max.x) / 2).toBeCloseTo(5, 0);
    expect((max.x - min.x) / 2).toBeGreaterThan(1.6);
    expect((max.x - min.x) / 2).toBeLessThan(3.6);
  });

  it("is the same rock every time", () => {
    const once = makeRockGeometry(rock, 3).getAttribute("position").array;
    expect(makeRockGeometry(rock, 3).getAttribute("position").array).toEqual(once);
  });

  it.each([false, true])("is a wall of its own length and width, from the bed up, with stones at its foot (plain: %s)", (plain) => {
    const { geometry, lamp } = makeBreakwater(wall, 3, "lighthouse", plain);
    const { min, max } = bounds(geometry);
    expect(max.x - min.x).toBeCloseTo(12, 1);
    expect(max.z - min.z).toBeGreaterThan(2);
    expect(max.z - min.z).toBeLessThan(3.6);
    expect(min.y).toBeLessThanOrEqual(-3);
    expect(max.y).toBeGreaterThan(lamp.yM);
    expect(lamp.yM).toBeGreaterThan(1 + 2);
    expect(lamp.xM).toBeLessThan(6);
    expect(geometry.getIndex()!.count / 3).toBeLessThan(plain ? 2500 : 5000);
  });

  it("has its stones at most a little outside of the simulated wall", () => {
    const positions = makeBreakwater(wall, 3, "beacon", false).geometry.getAttribute("position");
    for (let n = 0; n < positions.count; ++n) if (positions.getY(n) > 0.05) expect(Math.abs(positions.getZ(n))).toBeLessThan(1 + 0.15);
  });
});

describe("the lace of foam", () => {
  it("has every brightness equally often, so that foam of 0.5 covers half the water", () => {
    const lace = makeLace(64);
    const sorted = [...lace].sort((a, b) => a - b);
    for (const share of [0.1, 0.5, 0.9]) expect(sorted[Math.floor(share * sorted.length)]! / 256).toBeCloseTo(share, 2);
  });
});

describe("the tile of leaves", () => {
  it("is covered but for a few dark gaps, and has no seam where it repeats", () => {
    const side = 128;
    const leaves = makeLeaves(side);
    const gap = Math.min(...leaves);
    const share = leaves.filter((each) => each === gap).length / leaves.length;
    expect(share).toBeGreaterThan(0);
    expect(share).toBeLessThan(0.2);
    expect(Math.max(...leaves)).toBeGreaterThan(200);
    const across = (x0: number, x1: number): number => {
      let sum = 0;
      for (let y = 0; y < side; ++y) sum += Math.abs(leaves[y * side + x0]! - leaves[y * side + x1]!);
      return sum / side;
    };
    const inside = Array.from({ length: side - 1 }, (_, x) => across(x, x + 1));
    expect(across(side - 1, 0)).toBeLessThan(Math.max(...inside));
  });
});

describe("a sprig of a plant", () => {
  it("has two sides that are lit alike, as it is told", () => {
    const normal: Point = [0, 1, 0];
    const mesh = new MeshBuilder().leaf([0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], normal, [1, 1, 1, 1.8]).build();
    const normals = mesh.getAttribute("normal");
    for (let n = 0; n < normals.count; ++n) expect([normals.getX(n), normals.getY(n), normals.getZ(n)]).toEqual(normal);
    const facing = (first: number): number => {
      const [a, b, c] = [0, 1, 2].map((k) => new Vector3().fromBufferAttribute(mesh.getAttribute("position"), mesh.getIndex()!.getX(first + k)));
      return b!.sub(a!).cross(c!.sub(a!)).z;
    };
    expect(facing(0) * facing(6)).toBeLessThan(0);
  });
});

describe("a new boat's place", () => {
  const water = { sideM: 40, widthM: 40, waterExtents: { sideM: 40, longM: 40, depthM: 3 }, beaches: [...bed.beaches], obstacles: [rock, wall] };

  it("measures the distance to rocks and turned walls", () => {
    expect(clearanceM(rock, 5, -3)).toBeCloseTo(1, 9);
    expect(clearanceM(rock, 5, -6)).toBeCloseTo(-2, 9);
    const along = (m: number): [number, number] => [1 + m * Math.cos(0.5), 2 + m * Math.sin(0.5)];
    expect(clearanceM(wall, ...along(8))).toBeCloseTo(2, 9);
    expect(clearanceM(wall, ...along(0))).toBeCloseTo(-1, 9);
  });

  it("is deep enough and clear of everything, boat after boat", () => {
    const others: { xM: number; zM: number }[] = [];
    for (let i = 0; i < 8; ++i) {
      const place = spawnPlace(water, 2.4, 0.24, others);
      for (const obstacle of water.obstacles) expect(clearanceM(obstacle, place.xM, place.zM)).toBeGreaterThan(1.2);
      for (const other of others) expect(Math.hypot(place.xM - other.xM, place.zM - other.zM)).toBeGreaterThan(2.4);
      expect(depthAtM(bed, place.xM, place.zM)).toBeGreaterThan(0.3);
      expect(Math.max(Math.abs(place.xM), Math.abs(place.zM))).toBeLessThan(20);
      others.push(place);
    }
  });

  it("is near where one looks", () => {
    const from = { xM: -9, zM: 8 };
    const { xM, zM } = spawnPlace(water, 2.4, 0.24, [], from);
    expect(Math.hypot(xM - from.xM, zM - from.zM)).toBeLessThan(3);
    const beside = spawnPlace(water, 2.4, 0.24, [from], from);
    expect(Math.hypot(beside.xM - from.xM, beside.zM - from.zM)).toBeGreaterThan(2.4);
    expect(Math.hypot(beside.xM - from.xM, beside.zM - from.zM)).toBeLessThan(7);
  });

  it("is inside the water even if no place is free", () => {
    const full = { ...water, obstacles: [{ ...rock, xM: 0, zM: 0, radiusM: 100 }] };
    for (const from of [undefined, { xM: 15, zM: -15 }]) {
      const { xM, zM } = spawnPlace(full, 2.4, 0.24, [], from);
      expect(Math.max(Math.abs(xM), Math.abs(zM))).toBeLessThan(20);
    }
  });
});

// The geometry of boats: every type, as long, broad and deep as the server's hull, without holes, facing outward.
import type { BufferGeometry } from "three";
import { describe, expect, it } from "vitest";

import type { BoatDetail } from "../client/codec/greeting";
import { addShell, makeBoatParts } from "../src/scene/boats/boat_geometry";
import { hullKind, HullLines, sunkM } from "../src/scene/boats/lines";
import { liveryOf, paintOf } from "../src/scene/boats/livery";
import { MeshBuilder } from "../src/scene/meshes/mesh_builder";

const kBoats: Record<string, BoatDetail> = {
  "the shortest boat": { boatId: 1, lengthM: 0.3, beamM: 0.1, heightM: 0.05, draughtM: 0.0025 },
  "a dinghy": { boatId: 2, lengthM: 2.2, beamM: 0.85, heightM: 0.6, draughtM: 0.18 },
  "a launch": { boatId: 3, lengthM: 2.6, beamM: 0.95, heightM: 0.6, draughtM: 0.17 },
  "a heavy launch": { boatId: 4, lengthM: 2.4, beamM: 0.9, heightM: 0.6, draughtM: 0.57 },
  "a cutter": { boatId: 5, lengthM: 2.8, beamM: 1.2, heightM: 0.8, draughtM: 0.32 },
  "the largest boat": { boatId: 6, lengthM: 30, beamM: 15, heightM: 10, draughtM: 4 },
  "a boat as broad as long": { boatId: 7, lengthM: 4, beamM: 4, heightM: 1, draughtM: 0.3 },
};

function shellOf(boat: BoatDetail, plain: boolean): BufferGeometry {
  const lines = new HullLines(boat);
  const builder = new MeshBuilder();
  addShell(builder, lines, liveryOf(lines.kind, boat.boatId, undefined), plain);
  return builder.build();
}

type Triangle = [number, number, number][];

function trianglesOf(geometry: BufferGeometry): Triangle[] {
  const positions = geometry.getAttribute("position");
  const index = geometry.getIndex()!;
  return Array.from({ length: index.count / 3 }, (_, n) =>
    [0, 1, 2].map((k) => {
      const vertex = index.getX(3 * n + k);
      return [positions.getX(vertex), positions.getY(vertex), positions.getZ(vertex)] as [number, number, number];
    }),
  );
}

/** Directed edges without one in the opposite direction. */
function openEdges(triangles: readonly Triangle[], toleranceM: number): string[] {
  const key = (point: readonly number[]): string => point.map((value) => Math.round(value / toleranceM) + 0).join(",");
  const counts = new Map<string, number>();
  for (const triangle of triangles)
    for (let k = 0; k < 3; ++k) {
      const [a, b] = [key(triangle[k]!), key(triangle[(k + 1) % 3]!)];
      if (a === b) continue;
      const [edge, sign] = a < b ? [`${a} ${b}`, 1] : [`${b} ${a}`, -1];
      counts.set(edge, (counts.get(edge) ?? 0) + sign);
    }
  return [...counts].filter(([, count]) => count !== 0).map(([edge]) => edge);
}

/** By the divergence theorem; positive if the triangles of a closed surface face outward. */
function volumeOf(triangles: readonly Triangle[]): number {
  let volume = 0;
  for (const [[ax, ay, az], [bx, by, bz], [cx, cy, cz]] of triangles as [[number, number, number], [number, number, number], [number, number, number]][])
    volume += (ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)) / 6;
  return volume;
}

describe("the search for open edges", () => {
  it("finds the rim of a lone triangle, and none of a tetrahedron", () => {
    const [o, x, y, z]: [number, number, number][] = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
    expect(openEdges([[o!, x!, y!]], 1e-6)).toHaveLength(3);
    const tetrahedron: Triangle[] = [[o!, y!, x!], [o!, x!, z!], [o!, z!, y!], [x!, y!, z!]];
    expect(openEdges(tetrahedron, 1e-6)).toEqual([]);
    expect(volumeOf(tetrahedron)).toBeCloseTo(1 / 6, 9);
  });
});

it("the type of a boat follows from its length", () => {
  expect(["a dinghy", "a launch", "a cutter"].map((name) => hullKind(kBoats[name]!))).toEqual(["dinghy", "launch", "cutter"]);
});

describe.each(Object.entries(kBoats))("the hull of %s", (_, boat) => {
  const { lengthM, beamM, heightM, draughtM } = boat;
  const lines = new HullLines(boat);

  it.each([false, true])("has the length, beam, keel and deck of the server's (plain: %s)", (plain) => {
    const shell = shellOf(boat, plain);
    shell.computeBoundingBox();
    const { min, max } = shell.boundingBox!;
    expect(min.x / lengthM).toBeCloseTo(-0.5, 4);
    expect(max.x / lengthM).toBeCloseTo(0.5, 4);
    expect(min.z / beamM).toBeCloseTo(-0.5, 4);
    expect(max.z / beamM).toBeCloseTo(0.5, 4);
    expect(min.y / heightM).toBeCloseTo(-0.5, 4);
    const decks = Array.from({ length: 101 }, (_, n) => lines.deckM(n / 100));
    expect(Math.min(...decks) / heightM).toBeCloseTo(0.5, 3);
    // Of its freeboard three fifths are drawn.
    expect(heightM / 2 - lines.waterlineM).toBeCloseTo(0.6 * (heightM - draughtM), 9);
    expect(lines.waterlineM - sunkM(boat)).toBeCloseTo(-heightM / 2 + draughtM, 9);
  });

  it.each([false, true])("has no open edge and encloses its planking only (plain: %s)", (plain) => {
    const triangles = trianglesOf(shellOf(boat, plain));
    expect(openEdges(triangles, 1e-5 * lengthM)).toEqual([]);
    const volume = volumeOf(triangles);
    expect(volume).toBeGreaterThan(0);
    expect(volume).toBeLessThan(lengthM * beamM * heightM);
  });

  it("has finite places, and normals of length 1", () => {
    const { hull } = makeBoatParts(boat, undefined, false);
    const [positions, normals] = [hull.getAttribute("position"), hull.getAttribute("normal")];
    for (let n = 0; n < positions.count; ++n) {
      expect(Math.hypot(normals.getX(n), normals.getY(n), normals.getZ(n))).toBeCloseTo(1, 4);
      expect([positions.getX(n), positions.getY(n), positions.getZ(n)].every(Number.isFinite)).toBe(true);
    }
  });

  it("has a lid that covers it up to its sides and faces up", () => {
    const { lid } = makeBoatParts(boat, undefined, false);
    lid.computeBoundingBox();
    const { min, max } = lid.boundingBox!;
    expect((max.z - min.z) / beamM).toBeGreaterThan(0.85);
    expect((max.x - min.x) / lengthM).toBeGreaterThan(0.95);
    expect(min.y / heightM).toBeGreaterThan(0.499);
    const normals = lid.getAttribute("normal");
    for (let n = 0; n < normals.count; ++n) expect(normals.getY(n)).toBeGreaterThan(0.5);
  });

  it("has fair lines: breadths, keel and sheer without a step, and sections that widen upward", () => {
    for (let n = 0; n < 200; ++n) {
      const [a, b] = [n / 200, (n + 1) / 200];
      expect(Math.abs(lines.sheerHalfM(b) - lines.sheerHalfM(a))).toBeLessThan(0.06 * beamM);
      expect(Math.abs(lines.keelM(b) - lines.keelM(a))).toBeLessThan(0.03 * heightM);
      expect(lines.keelM(a)).toBeLessThan(lines.deckM(a) - 0.15 * heightM);
      for (let up = 0; up < 10; ++up) {
        const [low, high] = [up / 10, (up + 1) / 10].map((share) => lines.halfM(a, lines.keelM(a) + share * (lines.sheerM(a) - lines.keelM(a))));
        expect(high!).toBeGreaterThanOrEqual(low! - 1e-9);
      }
    }
  });

  it("has few triangles, and lights on both sides", () => {
    for (const [plain, most] of [[false, 3000], [true, 1000]] as const) {
      const { hull, lamps } = makeBoatParts(boat, undefined, plain);
      expect(hull.getIndex()!.count / 3).toBeLessThan(most);
      const zOf = (kind: string): number => lamps.find((lamp) => lamp.kind === kind)!.at[2];
      expect(zOf("port")).toBeLessThan(0);
      expect(zOf("starboard")).toBe(-zOf("port"));
    }
  });
});

describe("the paint of a boat", () => {
  it("is its owner's colour, as linear light", () => {
    expect(paintOf("#ffffff")!.slice(0, 3)).toEqual([0.8, 0.8, 0.8]);
    expect(paintOf("#000000")).toEqual([0, 0, 0, 0]);
    expect(paintOf("#80FF00")![0]).toBeCloseTo(0.8 * 0.2158, 3);
    expect(paintOf("red")).toBeUndefined();
    expect(paintOf("#12345")).toBeUndefined();
    const side = (color: string) => liveryOf("launch", 3, { owner: color, team: undefined }).side;
    expect(side("#e4572e")).toEqual(paintOf("#e4572e"));
    expect(side("no colour")).toEqual(liveryOf("launch", 3, undefined).side);
  });

  it("of a team has the team's colour at its sides, and the owner's on roof and stripe", () => {
    const { side, roof, stripe } = liveryOf("launch", 3, { owner: "#e4572e", team: "#2667e0" });
    expect(side).toEqual(paintOf("#2667e0"));
    expect([roof, stripe]).toEqual([paintOf("#e4572e"), paintOf("#e4572e")]);
  });
});

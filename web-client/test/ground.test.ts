import { create, toBinary } from "@bufbuild/protobuf";
import { describe, expect, it, vi } from "vitest";

import { readGround, type GroundGrid } from "../client/codec/ground";
import { isMalformed } from "../client/codec/malformed";
import { GroundRequests } from "../src/net/ground_request";
import { GroundSchema } from "../client/gen/spindrift/v1/api_pb";
import { makeGroundGeometry } from "../src/scene/landscape/landscape";
import { coastHeightM } from "../src/scene/landscape/coast";
import { depthAtM, type Bed } from "../src/scene/landscape/terrain";

/** The wire holds differences along rows, and of first numbers from the row before. */
function bytesOf(rises: number[][], change: { quantumM?: number; countX?: number } = {}): Uint8Array {
  const rise = rises.flatMap((row, z) => row.map((at, x) => at - (x > 0 ? row[x - 1]! : (rises[z - 1]?.[0] ?? 0))));
  return toBinary(GroundSchema, create(GroundSchema, { countX: rises[0]!.length, countZ: rises.length, lengthM: 12, widthM: 6, quantumM: 0.5, rise, ...change }));
}

function groundOf(rises: number[][]): GroundGrid {
  const read = readGround(bytesOf(rises));
  if (isMalformed(read)) throw new Error(read.reason);
  return read.ground;
}

const kRises = [
  [-4, -2, 0, 2],
  [-8, -6, 2, -1],
];

describe("requests for the ground", () => {
  it("run one at a time and take only the newest answer", async () => {
    const answers: ((ground: GroundGrid) => void)[] = [];
    const taken: [string, GroundGrid][] = [];
    const requests = new GroundRequests(() => new Promise((resolve) => answers.push(resolve)), (room, ground) => taken.push([room, ground]), () => {});
    const [first, second] = [groundOf(kRises), groundOf(kRises)];
    requests.ask("a");
    requests.ask("a");
    requests.ask("b");
    expect(answers).toHaveLength(1);
    answers[0]!(first);
    await vi.waitFor(() => expect(answers).toHaveLength(2));
    expect(taken).toEqual([]);
    answers[1]!(second);
    await vi.waitFor(() => expect(taken).toEqual([["b", second]]));
    expect(answers).toHaveLength(2);
  });

  it("that fail are told, and do not end further ones", async () => {
    const told: string[] = [];
    let isUp = false;
    const taken: string[] = [];
    const requests = new GroundRequests(() => (isUp ? Promise.resolve(groundOf(kRises)) : Promise.reject(new Error("404"))), (room) => taken.push(room), (message) => told.push(message));
    requests.ask("a");
    await vi.waitFor(() => expect(told).toEqual(["404"]));
    isUp = true;
    requests.ask("a");
    await vi.waitFor(() => expect(taken).toEqual(["a"]));
  });
});

describe("the ground of a scene with a bed", () => {
  it("is read from differences", () => {
    expect([...groundOf(kRises).riseM]).toEqual(kRises.flat().map((rise) => 0.5 * rise));
  });

  it("is refused if size and heights differ", () => {
    expect(readGround(bytesOf(kRises, { countX: 5 }))).toMatchObject({ reason: "ground: 8 heights for 5 x 2 cells" });
    expect(isMalformed(readGround(bytesOf(kRises, { quantumM: NaN })))).toBe(true);
    expect(isMalformed(readGround(new Uint8Array([255, 1, 2])))).toBe(true);
    expect(isMalformed(readGround(new Uint8Array()))).toBe(true);
  });

  it("is bilinear between the centres of cells and continues level beyond the last ones", () => {
    const bed: Bed = { sideM: 12, widthM: 6, depthM: 4, beaches: [], ground: groundOf(kRises) };
    expect(depthAtM(bed, -4.5, -1.5)).toBeCloseTo(2, 6);
    expect(depthAtM(bed, 4.5, 1.5)).toBeCloseTo(0.5, 6);
    expect(depthAtM(bed, -3, -1.5)).toBeCloseTo(1.5, 6);
    expect(depthAtM(bed, -3, 0)).toBeCloseTo((2 + 1 + 4 + 3) / 4, 6);
    expect(depthAtM(bed, -6, -3)).toBeCloseTo(2, 6);
    expect(depthAtM(bed, 60, -40)).toBeCloseTo(-1, 6);
  });

  it("is drawn with its land and its deepest place", () => {
    const bed: Bed = { sideM: 12, widthM: 6, depthM: 4, beaches: [], ground: groundOf(kRises) };
    const geometry = makeGroundGeometry(bed, 24);
    geometry.computeBoundingBox();
    expect(geometry.boundingBox!.max.y).toBeCloseTo(1, 1);
  });

  it("makes a shore of closed land and a quay of deep water", () => {
    const land: Bed = { sideM: 12, widthM: 6, depthM: 4, beaches: [], ground: groundOf([[-8, -8, 1, 1], [-8, -8, 1, 1]]) };
    const sides = { "+x": "closed", "-x": "closed", "+z": "open", "-z": "open" } as const;
    const coast = { bed: land, sides };
    expect(coastHeightM(coast, 6.001, 0)).toBeCloseTo(0.5, 2);
    expect(coastHeightM(coast, 12, 0)).toBeGreaterThan(0.6);
    expect(coastHeightM(coast, -5.9, 0)).toBeCloseTo(-4, 6);
    expect(coastHeightM(coast, -6.01, 0)).toBeGreaterThan(0.2);
  });
});

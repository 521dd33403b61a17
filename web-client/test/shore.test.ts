import { describe, expect, it } from "vitest";

import type { GreetingInfo } from "../client/codec/greeting";
import type { ObstacleInfo } from "../client/codec/scene_info";
import type { FoamFrame, SurfaceFrame } from "../src/net/messages";
import { meansOver, obstacleRise, shoreCells, shoreOf, shoreSamples, type ShoreCells } from "../src/scene/shore/shore_ground";
import { frontFoam, kDryingS, kFilmM, ShoreWetness, wetnessAfter } from "../src/scene/shore/shore_wetness";
import type { Bed } from "../src/scene/landscape/terrain";

const kRock: ObstacleInfo = { shape: "rock", xM: 1, zM: 0, radiusM: 2, heightM: 0.8 };
const kWall: ObstacleInfo = { shape: "breakwater", xM: 0, zM: 0, lengthM: 4, widthM: 1, headingRad: Math.PI / 2, heightM: 0.5 };
/** Rises by 0.25 m per metre over the last 8 m before +x, to 1 m over the water. */
const kBed: Bed = { sideM: 16, widthM: 4, depthM: 1, beaches: [{ side: "+x", widthM: 8, shoreDepthM: -1 }] };
const kCounts = { resolutionCount: 16, countZ: 4 };

describe("the ground under the cells of a moving shore", () => {
  it("has rocks as domes on cones without a kink", () => {
    expect(obstacleRise(kRock)(1, 0)).toBeCloseTo(0.8, 9);
    expect(obstacleRise(kRock)(3, 0)).toBeCloseTo(0, 9);
    expect(obstacleRise(kRock)(1, 4)).toBeCloseTo(-1.6, 9);
    const slope = (at: number): number => (obstacleRise(kRock)(at + 1e-6, 0) - obstacleRise(kRock)(at - 1e-6, 0)) / 2e-6;
    expect(slope(3 - 1e-4)).toBeCloseTo(slope(3 + 1e-4), 3);
  });

  it("has breakwaters as boxes along their heading", () => {
    expect(obstacleRise(kWall)(0, 1.9)).toBe(0.5);
    expect(obstacleRise(kWall)(0.6, 0)).toBe(-Infinity);
  });

  it("is the higher of bed and obstacles at the centres of cells", () => {
    const { bedM, groundM } = shoreCells(kBed, [kRock], kCounts);
    expect(bedM[0]).toBeCloseTo(-1, 6);
    expect(bedM[15]).toBeCloseTo(0.875, 6);
    // The centre (0.5, -0.5) is on the rock, 0.71 m from its middle.
    expect(bedM[8 + 16]).toBeCloseTo(-0.875, 6);
    expect(groundM[8 + 16]).toBeCloseTo(0.8 * (1 - 0.5 / 4), 6);
    expect(groundM[0]).toBeCloseTo(-1, 6);
  });

  it("is the mean over a sample at a lower level of detail", () => {
    const plane = Float32Array.from([0, 1, 2, 3, 10, 11, 12, 13]);
    expect([...meansOver(plane, { resolutionCount: 4, countZ: 2 }, { resolutionCount: 2, countZ: 1 })]).toEqual([5.5, 7.5]);
    const thirds = meansOver(Float32Array.from([0, 3, 6, 9]), { resolutionCount: 4, countZ: 1 }, { resolutionCount: 3, countZ: 1 });
    expect([...thirds].map((mean) => Math.round(1000 * mean) / 1000)).toEqual([0.75, 4.5, 8.25]);
    const coarse = shoreSamples(shoreCells(kBed, [], kCounts), { resolutionCount: 4, countZ: 2 });
    expect(coarse.bedM[3]).toBeCloseTo(0.5, 6);
  });

  it("is there only where nonlinear water meets ground, and not before the ground has come", () => {
    const of = (change: object): unknown => shoreOf({ wave: { isNonlinear: true, ...kCounts }, beaches: kBed.beaches, obstacles: [], hasBed: false, ...change } as unknown as GreetingInfo);
    expect(of({})).toBeDefined();
    expect(of({ wave: { isNonlinear: false, ...kCounts } })).toBeUndefined();
    expect(of({ beaches: [] })).toBeUndefined();
    expect(of({ beaches: [], obstacles: [kRock] })).toBeDefined();
    expect(of({ hasBed: true })).toBeUndefined();
    expect(of({ hasBed: true, ground: {} })).toBeDefined();
  });
});

/** Two cells of ground: 0.1 m over the still water, and 0.1 m under it. */
const kTwoCells: ShoreCells = { resolutionCount: 2, countZ: 1, groundM: Float32Array.from([0.1, -0.1]), bedM: Float32Array.from([0.1, -1]) };
let stateId = 1n;
const frame = (timeS: number, elevationsM: number[]): SurfaceFrame =>
  ({ layer: "surface", timeS, stateId: ++stateId, quantumM: 0.001, resolutionCount: elevationsM.length, countZ: 1, buffer: Int16Array.from(elevationsM, (m) => Math.round(1000 * m)).buffer }) as unknown as SurfaceFrame;
const foam = (bytes: number[]): FoamFrame => ({ resolutionCount: bytes.length, countZ: 1, buffer: Uint8Array.from(bytes).buffer }) as unknown as FoamFrame;
/** A wave that comes at 1 s, fills the land within 0.1 s to `depthM`, and is gone at 2 s. */
function washed(depthM: number, streamed?: FoamFrame): ShoreWetness {
  const wetness = new ShoreWetness();
  wetness.advance(frame(0.9, [0.1, 0]), undefined, kTwoCells);
  wetness.advance(frame(1, [0.1 + depthM, 0]), streamed, kTwoCells);
  wetness.advance(frame(2, [0.1, 0]), undefined, kTwoCells);
  return wetness;
}

describe("the wetness of the ground", () => {
  it("falls from 1 to 0 while the ground dries", () => {
    expect(wetnessAfter(0)).toBe(1);
    expect(wetnessAfter(kDryingS / 2)).toBeCloseTo(0.5, 9);
    expect(wetnessAfter(2 * kDryingS)).toBe(0);
    expect(wetnessAfter(Infinity)).toBe(0);
  });

  it("begins for a late joiner with where water stands now", () => {
    const wetness = new ShoreWetness();
    expect(wetness.at(0.25, 0.5)).toBeUndefined();
    wetness.advance(frame(100, [0.1, 0]), undefined, kTwoCells);
    expect(wetness.at(0.25, 0.5)).toEqual({ wetness: 0, foam: 0 });
    expect(wetness.at(0.75, 0.5)).toEqual({ wetness: 1, foam: 0 });
  });

  it("stays behind a wave and dries at the same pace whatever the rate of frames", () => {
    const [few, many] = [washed(0.05), washed(0.05)];
    for (let timeS = 2; timeS < 17; timeS += 0.25) many.advance(frame(timeS, [0.1, 0]), undefined, kTwoCells);
    for (const wetness of [few, many]) wetness.advance(frame(17, [0.1, 0]), undefined, kTwoCells);
    expect(few.at(0, 0)!.wetness).toBeCloseTo(wetnessAfter(16), 2);
    expect(many.at(0, 0)!.wetness).toBe(few.at(0, 0)!.wetness);
    few.advance(frame(2 + kDryingS, [0.1, 0]), undefined, kTwoCells);
    expect(few.at(0, 0)!.wetness).toBe(0);
  });

  it("does not come from a film that is thinner than the rounding of frames", () => {
    expect(washed(kFilmM).at(0, 0)!.wetness).toBe(0);
    expect(washed(2 * kFilmM).at(0, 0)!.wetness).toBeGreaterThan(0.9);
  });

  it("begins anew when the water was reset", () => {
    const wetness = washed(0.05);
    wetness.advance(frame(0.02, [0.1, 0]), undefined, kTwoCells);
    expect(wetness.at(0, 0)).toEqual({ wetness: 0, foam: 0 });
  });

  it("is kept at another level of detail", () => {
    const wetness = washed(0.05);
    const four: ShoreCells = { resolutionCount: 4, countZ: 1, groundM: Float32Array.from([0.1, 0.1, -0.1, -0.1]), bedM: Float32Array.from([0.1, 0.1, -1, -1]) };
    wetness.advance(frame(2.1, [0.1, 0.1, 0, 0]), undefined, four);
    expect(wetness.at(0, 0)!.wetness).toBeGreaterThan(0.9);
    wetness.clear();
    wetness.advance(frame(2.2, [0.1, 0.1, 0, 0]), undefined, four);
    expect(wetness.at(0, 0)!.wetness).toBe(0);
  });
});

describe("the foam of the swash", () => {
  it("is white at a fast front only", () => {
    expect(frontFoam(0.05, 0.1)).toBeGreaterThan(0.9);
    expect(frontFoam(0.01, 0.4)).toBe(0);
    expect(frontFoam(0.05, 5)).toBe(0);
    expect(frontFoam(kFilmM, 0.01)).toBe(0);
  });

  it("stays on the ground longer than on water", () => {
    const left = washed(0.05).at(0, 0)!.foam;
    expect(left).toBeGreaterThan(0.7);
    const covered = new ShoreWetness();
    covered.advance(frame(0.9, [0.1, 0]), undefined, kTwoCells);
    for (const timeS of [1, 2]) covered.advance(frame(timeS, [0.15, 0]), undefined, kTwoCells);
    expect(covered.at(0, 0)!.foam).toBeLessThan(left);
    expect(covered.at(0, 0)!.foam).toBeGreaterThan(0.3);
  });

  it("comes from streamed foam on thin water alone", () => {
    const creeping = new ShoreWetness();
    creeping.advance(frame(0, [0.11, 0]), undefined, kTwoCells);
    creeping.advance(frame(0.1, [0.11, 0]), foam([128, 255]), kTwoCells);
    expect(creeping.at(0, 0)!.foam).toBeCloseTo(0.5, 2);
    expect(creeping.at(0.9, 0)!.foam).toBe(0);
  });

  it("is not drawn from frames that are far apart", () => {
    const wetness = new ShoreWetness();
    wetness.advance(frame(0, [0.1, 0]), undefined, kTwoCells);
    wetness.advance(frame(0.4, [0.2, 0]), undefined, kTwoCells);
    expect(wetness.at(0, 0)).toEqual({ wetness: 1, foam: 0 });
  });
});

// The values that the range of a look follows: those of the water, not of land.
import { describe, expect, it } from "vitest";

import type { SurfaceFrame } from "../src/net/messages";
import { ShownSurface } from "../src/scene/looks/surface_values";
import { kBeyondShares, reachOf } from "../src/scene/looks/value_range";
import { waterMagnitudes } from "../src/scene/looks/water_magnitudes";

const kSideM = 32;
const kCount = 96;
const kQuantumM = 1e-3;

/** A harbour: 1.2 m deep, a beach that rises to 0.6 m above the water on the last third, a rock, and a surface as it is streamed: the ground on land. */
const greeting = {
  sideM: kSideM,
  widthM: kSideM,
  waterExtents: { sideM: kSideM, longM: kSideM, depthM: 1.2 },
  beaches: [{ side: "+x" as const, widthM: 10, shoreDepthM: -0.6 }],
  obstacles: [{ shape: "rock" as const, xM: -8, zM: 6, radiusM: 2, heightM: 1 }],
};

function surfaceOf(waterM: (xM: number, zM: number) => number): ShownSurface {
  const at = (i: number): number => ((i + 0.5) / kCount - 0.5) * kSideM;
  const heightM = (xM: number, zM: number): number => {
    if (Math.hypot(xM + 8, zM - 6) < 2) return 1;
    const groundM = -1.2 + Math.max(0, (1.8 * (xM - 6)) / 10);
    return Math.max(groundM, waterM(xM, zM));
  };
  const samples = Int16Array.from({ length: kCount ** 2 }, (_, i) => Math.round(heightM(at(i % kCount), at(Math.floor(i / kCount))) / kQuantumM));
  const frame: SurfaceFrame = { layer: "surface", tick: 1n, stateId: 0n, timeS: 0, serverTimeS: 0, level: "full", resolutionCount: kCount, countZ: kCount, sideM: kSideM, widthM: kSideM, quantumM: kQuantumM, buffer: samples.buffer };
  return new ShownSurface({ sideM: kSideM, widthM: kSideM, periodicX: false, periodicZ: false }, { weights: [0, 1, 0, 0], ratesPerS: [0, 0, 0, 0], isRateKnown: false, frames: [frame, frame, frame, frame] });
}

describe("the values of the water", () => {
  const ripples = (xM: number, zM: number): number => 0.05 * Math.sin(2 * xM) * Math.cos(zM);

  it("leave out land, films of water and obstacles, which are higher than every wave", () => {
    const magnitudes = waterMagnitudes(surfaceOf(ripples), greeting, "elevation");
    expect(magnitudes.length).toBeGreaterThan(3000);
    expect(magnitudes.length).toBeLessThan(4096 * 0.9);
    // A position beside the rock is interpolated between rock and water.
    expect(magnitudes.filter((magnitude) => magnitude > 0.1).length).toBeLessThan(0.5 * kBeyondShares.surface * magnitudes.length);
    expect(reachOf(magnitudes, 0.01, kBeyondShares.surface)).toBeLessThan(0.05);
  });

  it("do not follow the highest crest: a narrow one of 0.4 m leaves the ripples their colours", () => {
    const crest = (xM: number, zM: number): number => ripples(xM, zM) + 0.4 * Math.exp(-((xM + 5) ** 2) / 0.2);
    expect(reachOf(waterMagnitudes(surfaceOf(crest), greeting, "elevation"), 0.01, kBeyondShares.surface)).toBeLessThan(0.1);
  });
});

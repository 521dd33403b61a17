// What the probe reads: values of the surface and of particles, and that they are what the shaders draw.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { describe, expect, it } from "vitest";

import type { FoamFrame, SurfaceFrame } from "../src/net/messages";
import { isCovered } from "../src/scene/landscape/clearance";
import { kDensityRatios, densityRatio, pickParticle, placeM, speedMps, type ShownParticles } from "../src/scene/frames/particle_values";
import { breakingCriterion, foamAt, kLeastDepths, ShownSurface, type Rectangle } from "../src/scene/looks/surface_values";
import type { ShownSurfaces } from "../src/scene/water/field_pass";
import { timeRateWeights, timeWeights, type FrameTimes } from "../src/scene/frames/time_weights";
import { describePlace, describeValue } from "../src/ui/probe_label";

const kSquare: Rectangle = { sideM: 8, widthM: 8, periodicX: false, periodicZ: false };
const kTimes: FrameTimes = { beforeS: 1, fromS: 1.05, toS: 1.1, afterS: 1.15 };

function frameOf(timeS: number, n: number, quantumM: number, elevationM: (xM: number, zM: number) => number): SurfaceFrame {
  const at = (i: number): number => ((i + 0.5) / n - 0.5) * kSquare.sideM;
  const samples = Int16Array.from({ length: n * n }, (_, index) => Math.round(elevationM(at(index % n), at(Math.floor(index / n))) / quantumM));
  return { layer: "surface", tick: 1n, stateId: 0n, timeS, serverTimeS: 0, level: "full", resolutionCount: n, countZ: n, sideM: kSquare.sideM, widthM: kSquare.sideM, quantumM, buffer: samples.buffer };
}

function shownOf(times: FrameTimes, mix: number, n: number, elevationM: (timeS: number, xM: number, zM: number) => number, quanta = [1e-4, 1e-4, 1e-4, 1e-4]): ShownSurfaces {
  const weights: [number, number, number, number] = [0, 0, 0, 0];
  const ratesPerS: [number, number, number, number] = [0, 0, 0, 0];
  timeWeights(times, mix, weights);
  const isRateKnown = timeRateWeights(times, mix, ratesPerS);
  const timesS = [times.beforeS ?? times.fromS, times.fromS, times.toS, times.afterS ?? times.toS];
  return { weights, ratesPerS, isRateKnown, frames: timesS.map((timeS, i) => frameOf(timeS, n, quanta[i]!, (xM, zM) => elevationM(timeS, xM, zM))) };
}

describe("the probe of the surface", () => {
  it("reads the elevation of a sample exactly, and between samples bilinearly", () => {
    const shown = shownOf(kTimes, 0, 4, (_, xM, zM) => 0.1 * xM + 0.02 * zM * xM);
    const surface = new ShownSurface(kSquare, shown);
    expect(surface.elevationM(-3, 1)).toBeCloseTo(-0.36, 12);
    expect(surface.elevationM(0, 0)).toBeCloseTo((-0.08 - 0.12 + 0.12 + 0.08) / 4, 12);
    expect(surface.elevationM(2, 1)).toBeCloseTo(0.5 * (0.12 + 0.36), 12);
    expect(surface.quantumM).toBe(1e-4);
  });

  it("reads the time shown, not the newest frame, also from frames of different quanta", () => {
    const parabola = (timeS: number): number => 0.3 + 0.2 * (timeS - 1.08) - 4 * (timeS - 1.08) ** 2;
    const surface = new ShownSurface(kSquare, shownOf(kTimes, 0.4, 4, parabola, [1e-5, 2e-5, 1e-5, 3e-5]));
    expect(surface.elevationM(0.3, -2)).toBeCloseTo(parabola(1.07), 4);
    expect(surface.rateMps(0.3, -2)).toBeCloseTo(0.2 + 8 * 0.01, 2);
    const { minM, maxM } = surface.boundsM();
    expect(minM).toBeLessThanOrEqual(surface.elevationM(0.3, -2) + 1e-12);
    expect(maxM).toBeGreaterThanOrEqual(surface.elevationM(0.3, -2) - 1e-12);
    expect(maxM - minM).toBeLessThan(0.01);
  });

  it("continues on the other side of a periodic square, and holds the edge of another", () => {
    const ramp = shownOf(kTimes, 0, 4, (_, xM) => 0.01 * xM);
    expect(new ShownSurface(kSquare, ramp).elevationM(4, 0)).toBeCloseTo(0.03, 12);
    expect(new ShownSurface({ ...kSquare, periodicX: true }, ramp).elevationM(4, 0)).toBeCloseTo(0, 12);
  });

  it("reads the breaking criterion of a wave front that rises evenly", () => {
    const rising = new ShownSurface(kSquare, shownOf(kTimes, 0.5, 8, (timeS) => 1.2 * (timeS - 1)));
    const bed = { sideM: 8, widthM: 8, depthM: 2, beaches: [{ side: "+x" as const, widthM: 4, shoreDepthM: 0 }] };
    expect(breakingCriterion(rising, bed, 9.81, -1, 0)).toBeCloseTo(1.2 / Math.sqrt(9.81 * 2), 3);
    expect(breakingCriterion(rising, bed, 9.81, 2, 0)).toBeCloseTo(1.2 / Math.sqrt(9.81 * 1), 3);
    // Nearly dry: finite.
    expect(breakingCriterion(rising, bed, 9.81, 4, 0)).toBeCloseTo(1.2 / Math.sqrt(9.81 * 2 * kLeastDepths), 2);
  });

  it("smooths the criterion as the server does: weights 1 2 1 along each axis", () => {
    const n = 8;
    const atSample = (i: number): number => ((i + 0.5) / n - 0.5) * 8;
    const spike = (timeS: number, xM: number, zM: number): number => (Math.abs(xM - atSample(4)) < 0.1 && Math.abs(zM - atSample(4)) < 0.1 ? timeS - 1 : 0);
    const surface = new ShownSurface(kSquare, shownOf(kTimes, 0.5, n, spike));
    const bed = { sideM: 8, widthM: 8, depthM: 1, beaches: [] };
    const weights = [3, 4, 5].map((k) => [3, 4, 5].map((i) => Math.round(16 * breakingCriterion(surface, bed, 1, atSample(i), atSample(k)) * 100) / 100));
    expect(weights).toEqual([[1, 2, 1], [2, 4, 2], [1, 2, 1]]);
  });

  it("reads the foam between two frames", () => {
    const foam = (value: number, n: number): FoamFrame => ({ layer: "foam", tick: 1n, stateId: 0n, timeS: 0, serverTimeS: 0, level: "full", resolutionCount: n, countZ: n, sideM: 8, widthM: 8, buffer: new Uint8Array(n * n).fill(value).buffer });
    const [from, to] = [foam(50, 4), foam(250, 4)];
    expect(foamAt(kSquare, { before: undefined, after: undefined, from, to, mix: 0.25 }, 1, 1)).toBeCloseTo(100, 9);
    // Frames of two levels cannot be mixed.
    expect(foamAt(kSquare, { before: undefined, after: undefined, from: foam(50, 8), to, mix: 0.25 }, 1, 1)).toBe(250);
  });

  it("finds no water where an obstacle stands", () => {
    const rock = { shape: "rock" as const, xM: 2, zM: 1, radiusM: 1, heightM: 1 };
    const wall = { shape: "breakwater" as const, xM: 0, zM: 0, lengthM: 4, widthM: 1, headingRad: Math.PI / 2, heightM: 1 };
    expect(isCovered([rock], 2.9, 1)).toBe(true);
    expect(isCovered([rock], 3.1, 1)).toBe(false);
    expect(isCovered([wall], 0.4, 1.9)).toBe(true);
    expect(isCovered([wall], 1.9, 0.4)).toBe(false);
  });
});

function particles(...records: [x: number, z: number, y: number, velocity: [number, number, number], tint: number][]): ShownParticles {
  const bytes = new Uint8Array(12 * records.length);
  const view = new DataView(bytes.buffer);
  records.forEach(([x, z, y, velocity, tint], i) => {
    [x, z, y].forEach((word, axis) => view.setUint16(12 * i + 2 * axis, word, true));
    velocity.forEach((v, axis) => view.setInt8(12 * i + 6 + axis, v));
    view.setUint8(12 * i + 9, tint);
  });
  const frame = { count: records.length, wordMinM: [0, 0, 0] as [number, number, number], wordMaxM: [6.5535, 6.5535, 6.5535] as [number, number, number], maxSpeedMps: 12.7, radiusM: 0.1 };
  return { frame, words: new Uint16Array(bytes.buffer), advanceS: 0 };
}

describe("the probe of particles", () => {
  it("reads speed, density and place of the streamed bytes", () => {
    const shown = particles([10_000, 20_000, 30_000, [-30, 40, 0], 255], [0, 0, 0, [0, 0, -127], 51]);
    expect(speedMps(shown, 0)).toBeCloseTo(5, 9);
    expect(speedMps(shown, 1)).toBeCloseTo(12.7, 9);
    expect(densityRatio(shown, 0)).toBeCloseTo(1.1, 9);
    expect(densityRatio(shown, 1)).toBeCloseTo(0.62, 9);
    const place = placeM({ ...shown, advanceS: 0.1 }, 0);
    [0.7, 3.4, 2].forEach((valueM, axis) => expect(place[axis]).toBeCloseTo(valueM, 9));
  });

  it("finds the particle that is nearest along the ray, moved along its velocity", () => {
    const shown = particles([10_000, 50_000, 10_000, [0, 0, 0], 0], [10_000, 20_000, 10_000, [0, 0, 0], 0], [30_000, 30_000, 10_000, [-100, 0, 0], 0]);
    const ray = { originM: [1, 1, 6.5] as const, direction: [0, 0, -1] as const };
    expect(pickParticle(ray, shown)).toBe(0);
    expect(pickParticle(ray, shown, 1)).toBeUndefined();
    expect(pickParticle({ ...ray, originM: [1, 1, 4] }, shown)).toBe(1);
    expect(pickParticle({ ...ray, originM: [1, 1, 4] }, { ...shown, advanceS: 0.2 })).toBe(2);
    expect(pickParticle({ ...ray, originM: [5, 1, 4] }, shown)).toBeUndefined();
  });
});

describe("the label", () => {
  const quantity = { look: "height" as const, unit: "m", map: "coolWarm" as const, range: "signed" as const, of: "surface" as const };

  it("has the unit and no more decimals than the stream can tell apart", () => {
    expect(describeValue({ quantity, value: 0.12345, step: 0.0005 })).toBe("0.1235 m");
    expect(describeValue({ quantity, value: 0.12345, step: 0.02 })).toBe("0.12 m");
    expect(describeValue({ quantity, value: -0.0004, step: 0.01 })).toBe("0.00 m");
    expect(describeValue({ quantity: { ...quantity, unit: "" }, value: 1.1, step: 0.002, bound: "high" })).toBe("≥ 1.100");
  });

  it("has the place, with the height of particles", () => {
    expect(describePlace({ quantity, xM: 1, yM: 2, zM: -3.456 })).toBe("x 1.00 m, z -3.46 m");
    expect(describePlace({ quantity: { ...quantity, of: "particles" }, xM: 1, yM: 2, zM: -3 })).toBe("x 1.00 m, y 2.00 m, z -3.00 m");
  });
});

describe("the shaders of the looks", () => {
  const text = (name: string): string => readFileSync(join(import.meta.dirname, "..", "src", "scene", "shaders", name), "utf8");

  it("decode particles as the probe does", () => {
    const shader = text("look_particle.vert");
    expect(shader).toContain("#include <fluid_words>");
    const { low, high } = kDensityRatios;
    expect(shader).toContain(`${low} + ${(high - low).toFixed(1)} * particle.density`);
    expect(text("fluid_words.glsl")).toContain("float(words.y >> 8u) / 255.0");
  });
});

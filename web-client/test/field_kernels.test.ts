import { describe, expect, it } from "vitest";

import { kCurvature, kSlope, kSmooth } from "../src/scene/water/field_kernels";

type Taps = readonly [number, number, number];

/** Share of an even wave's height behind symmetric taps. */
function evenResponse(taps: Taps, radPerSample: number): number {
  return taps[0] + 2 * taps[1] * Math.cos(radPerSample) + 2 * taps[2] * Math.cos(2 * radPerSample);
}

/** The slope that odd taps give for a wave of height 1, over its slope `radPerSample`. */
function slopeResponse(taps: Taps, radPerSample: number): number {
  return (2 * taps[1] * Math.sin(radPerSample) + 2 * taps[2] * Math.sin(2 * radPerSample)) / radPerSample;
}

const radPerSample = (samples: number): number => (2 * Math.PI) / samples;

describe("the field's kernels", () => {
  it("keep a level surface, a slope and a curvature", () => {
    expect(evenResponse(kSmooth, 0)).toBeCloseTo(1, 12);
    expect(slopeResponse(kSlope, 1e-4)).toBeCloseTo(1, 7);
    expect(evenResponse(kCurvature, 1e-3) / -1e-6).toBeCloseTo(1, 5);
  });

  it("keep short waves: at 8 samples within 2.5 %, at 4 samples three quarters", () => {
    expect(evenResponse(kSmooth, radPerSample(8))).toBeGreaterThan(0.975);
    expect(slopeResponse(kSlope, radPerSample(8))).toBeGreaterThan(0.985);
    expect(evenResponse(kSmooth, radPerSample(4))).toBeGreaterThan(0.749);
    expect(slopeResponse(kSlope, radPerSample(4))).toBeGreaterThan(0.84);
  });

  it("remove steps from sample to sample", () => {
    expect(evenResponse(kSmooth, Math.PI)).toBeCloseTo(0, 12);
    expect(slopeResponse(kSlope, Math.PI)).toBeCloseTo(0, 12);
  });

  it("never raise a wave", () => {
    for (let samples = 2; samples < 40; samples += 0.25) {
      expect(Math.abs(evenResponse(kSmooth, radPerSample(samples)))).toBeLessThanOrEqual(1);
      expect(Math.abs(slopeResponse(kSlope, radPerSample(samples)))).toBeLessThanOrEqual(1);
    }
  });
});

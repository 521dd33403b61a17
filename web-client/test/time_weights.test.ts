import { describe, expect, it } from "vitest";

import { timeRateWeights, timeWeights, type FrameTimes } from "../src/scene/frames/time_weights";

type Weights = [number, number, number, number];

function weightsOf(times: FrameTimes, mix: number): Weights {
  const out: Weights = [9, 9, 9, 9];
  timeWeights(times, mix, out);
  return out;
}

/** The curve through samples of `signal` at these times. */
function shown(times: FrameTimes, mix: number, signal: (timeS: number) => number): number {
  const [w0, w1, w2, w3] = weightsOf(times, mix);
  const at = (weight: number, timeS: number | undefined): number => (timeS === undefined ? 0 : weight * signal(timeS));
  return at(w0, times.beforeS) + at(w1, times.fromS) + at(w2, times.toS) + at(w3, times.afterS);
}

const kEven: FrameTimes = { beforeS: -1, fromS: 0, toS: 1, afterS: 2 };
const kUneven: FrameTimes = { beforeS: -0.6, fromS: 0, toS: 1, afterS: 2.4 };
const kMixes = [0, 0.2, 0.5, 0.7, 1];

/** Lowest amplitude of a travelling wave between two frames, as a share of its own. */
function lowestAmplitude(periodS: number, rateHz: number, neighbours: boolean): number {
  const stepS = 1 / rateHz;
  const times: FrameTimes = { beforeS: neighbours ? -stepS : undefined, fromS: 0, toS: stepS, afterS: neighbours ? 2 * stepS : undefined };
  const omega = (2 * Math.PI) / periodS;
  let lowest = 1;
  for (let mix = 0; mix <= 1; mix += 0.05) {
    const cosine = shown(times, mix, (timeS) => Math.cos(omega * timeS));
    const sine = shown(times, mix, (timeS) => Math.sin(omega * timeS));
    lowest = Math.min(lowest, Math.hypot(cosine, sine));
  }
  return lowest;
}

describe("the curve between two frames", () => {
  it("passes through both frames, and its weights sum to 1", () => {
    for (const times of [kEven, kUneven, { ...kEven, beforeS: undefined }, { ...kEven, afterS: undefined }]) {
      const sums = kMixes.map((mix) => weightsOf(times, mix).reduce((sum, weight) => sum + weight));
      for (const sum of sums) expect(sum).toBeCloseTo(1, 12);
      const signal = (timeS: number): number => Math.sin(3 * timeS);
      expect(shown(times, 0, signal)).toBeCloseTo(signal(0), 12);
      expect(shown(times, 1, signal)).toBeCloseTo(signal(1), 12);
    }
  });

  it("is Catmull-Rom's for even frames", () => {
    const [w0, w1, w2, w3] = weightsOf(kEven, 0.5);
    expect([w0, w1, w2, w3].map((weight) => 16 * weight)).toEqual([-1, 9, 9, -1]);
  });

  it("reproduces a parabola, with uneven frames and with a neighbour on one side only", () => {
    const parabola = (timeS: number): number => 2 - 3 * timeS + 5 * timeS * timeS;
    for (const times of [kUneven, { ...kUneven, beforeS: undefined }, { ...kUneven, afterS: undefined }]) {
      for (const mix of kMixes) expect(shown(times, mix, parabola)).toBeCloseTo(parabola(mix), 10);
    }
  });

  it("has equal slopes on both sides of a frame", () => {
    const signal = (timeS: number): number => Math.sin(1.3 * timeS + 0.4);
    const step = 1e-5;
    const next: FrameTimes = { beforeS: 0, fromS: 1, toS: 2, afterS: 3 };
    const endSlope = (shown(kEven, 1, signal) - shown(kEven, 1 - step, signal)) / step;
    const startSlope = (shown(next, step, signal) - shown(next, 0, signal)) / step;
    expect(endSlope).toBeCloseTo(startSlope, 3);
  });

  it("is a straight line without neighbours, and next to a gap in the frames", () => {
    expect(weightsOf({ beforeS: undefined, fromS: 0, toS: 1, afterS: undefined }, 0.25)).toEqual([0, 0.75, 0.25, 0]);
    expect(weightsOf({ beforeS: -9, fromS: 0, toS: 1, afterS: 11 }, 0.25)).toEqual([0, 0.75, 0.25, 0]);
  });

  it("stays at the frame where there is only one", () => {
    expect(weightsOf({ beforeS: undefined, fromS: 4, toS: 4, afterS: undefined }, 0)).toEqual([0, 1, 0, 0]);
  });

  it("keeps the height of short waves between frames", () => {
    // 4 cells of the scene splash are 0.33 m long and have a period of 0.46 s; the coarse level has 15 frames per second.
    for (const [rateHz, line, curve] of [[30, 0.974, 0.999], [15, 0.898, 0.985]] as const) {
      expect(lowestAmplitude(0.46, rateHz, false)).toBeCloseTo(line, 3);
      expect(lowestAmplitude(0.46, rateHz, true)).toBeCloseTo(curve, 3);
    }
  });
});

describe("the rate between two frames", () => {
  const ratesOf = (times: FrameTimes, mix: number): Weights => {
    const out: Weights = [9, 9, 9, 9];
    expect(timeRateWeights(times, mix, out)).toBe(true);
    return out;
  };

  it("is the derivative by time of the curve, with and without neighbours", () => {
    const step = 1e-6;
    for (const times of [kEven, kUneven, { ...kUneven, beforeS: undefined }, { ...kUneven, afterS: undefined }, { beforeS: -9, fromS: 0, toS: 0.5, afterS: 11 }])
      for (const mix of [0.1, 0.5, 0.8]) {
        const intervalS = times.toS - times.fromS;
        const [low, high] = [weightsOf(times, mix - step), weightsOf(times, mix + step)];
        ratesOf(times, mix).forEach((rate, i) => expect(rate).toBeCloseTo((high[i]! - low[i]!) / (2 * step * intervalS), 6));
      }
  });

  it("is that of the line to a neighbour at the time of a frame", () => {
    expect(ratesOf({ beforeS: 3.5, fromS: 4, toS: 4, afterS: undefined }, 0)).toEqual([-2, 2, 0, 0]);
    expect(ratesOf({ beforeS: undefined, fromS: 4, toS: 4, afterS: 4.25 }, 0)).toEqual([0, 0, -4, 4]);
  });

  it("is not known from a single frame", () => {
    const out: Weights = [9, 9, 9, 9];
    expect(timeRateWeights({ beforeS: undefined, fromS: 4, toS: 4, afterS: undefined }, 0, out)).toBe(false);
    expect(out).toEqual([0, 0, 0, 0]);
  });
});

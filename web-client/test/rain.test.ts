import { describe, expect, it } from "vitest";

import type { WindInfo } from "../client/codec/scene_info";
import { hazeM, rainShare } from "../src/scene/light/weather";
import { makeDropSeeds } from "../src/scene/rain/drop_seeds";
import { withParameter } from "../src/scene/sea/sea_state";

const storm: WindInfo = { seed: 1n, gravityMps2: 9.81, comesIn: false, levelRatio: 1, dropsPerM2S: 0.08, waveHeightM: 0.3, directionDeg: 0, speedMps: 15, fetchM: 2000 };

describe("the rain in the picture", () => {
  it("grows with storm and drops, without single drops", () => {
    expect(rainShare(storm)).toBe(1);
    expect(rainShare({ ...storm, dropsPerM2S: 2 })).toBe(1);
    expect(rainShare(undefined)).toBe(0);
    expect(rainShare({ ...storm, dropsPerM2S: 0 })).toBe(0);
    expect(rainShare({ ...storm, levelRatio: 0.1, dropsPerM2S: 0.06 })).toBe(0);
    // Without waves it is a shower.
    expect(rainShare({ ...storm, waveHeightM: 0, levelRatio: 0.1, dropsPerM2S: 0.06 })).toBeCloseTo(0.075, 9);
    let before = 0;
    for (let levelRatio = 0; levelRatio <= 1; levelRatio += 0.05) {
      const share = rainShare({ ...storm, levelRatio });
      expect(share).toBeGreaterThanOrEqual(before);
      expect(share - before).toBeLessThan(0.1);
      before = share;
    }
  });

  it("follows the room's parameters", () => {
    expect(rainShare(withParameter(storm, "storm.drops_per_m2_s", 0.04))).toBeCloseTo(0.15 / 0.65, 9);
    expect(rainShare(withParameter(storm, "storm.level_ratio", 0))).toBe(0);
  });

  it("makes the air hazier", () => {
    const room = { sideM: 16, widthM: 16, wind: storm } as Parameters<typeof hazeM>[0];
    expect(hazeM(room)).toBeLessThan(0.5 * hazeM({ ...room, wind: { ...storm, levelRatio: 0 } }));
    expect(hazeM(room)).toBeGreaterThan(16);
  });

  it("gives all vertices of a drop the same random numbers, and each its number", () => {
    const random = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
    const seeds = makeDropSeeds(2, 2, () => random.shift()!);
    const wanted = [0.1, 0.2, 0.3, 0, 0.1, 0.2, 0.3, 1, 0.4, 0.5, 0.6, 0, 0.4, 0.5, 0.6, 1];
    expect(seeds).toHaveLength(wanted.length);
    wanted.forEach((value, at) => expect(seeds[at]).toBeCloseTo(value, 6));
  });
});

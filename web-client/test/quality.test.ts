// The tiers of the drawing's quality, and the choice of one by the time that pictures take.
import { describe, expect, it } from "vitest";

import { chooseQuality, firstTier, isSoftware, kTierNames, kTiers, type TierName } from "../src/scene/drawing/quality";
import { QualityGovernor } from "../src/scene/drawing/quality_governor";

/** Settings of a tier that cost time, as numbers that grow with it. */
function costsOf(tier: TierName): number[] {
  const { maxPixelRatio, frameRateMaxHz, surfaceCellsCount, samplesCount, plain, fieldCountMax, seaTexelsCount, mirrorStepsCount, fluid, whitewater, rain, caustics, shadows } = kTiers[tier];
  return [
    ...[maxPixelRatio, frameRateMaxHz, surfaceCellsCount, samplesCount, Number(!plain), fieldCountMax, seaTexelsCount, mirrorStepsCount],
    ...Object.values(fluid ?? { cellsPerSpacing: 0, scale: 0, dropsCount: 0, floorTexelsCount: 0 }),
    ...Object.values(whitewater),
    ...Object.values(rain),
    ...[caustics?.cellsCount ?? 0, caustics?.texelsCount ?? 0, shadows?.texelsCount ?? 0],
  ];
}

/** Notes pictures until their times add up to `forMs`; returns how often tier or resolution changed. */
function draw(governor: QualityGovernor, frameMs: number | ((tier: TierName) => number), forMs: number): number {
  let changes = 0;
  for (let ms = 0; ms < forMs; ) {
    const tookMs = typeof frameMs === "number" ? frameMs : frameMs(governor.tier);
    ms += tookMs;
    if (governor.note(tookMs)) ++changes;
  }
  return changes;
}

describe("the tiers", () => {
  it("never cost less in any setting than the tier below", () => {
    for (let i = 1; i < kTierNames.length; ++i) {
      const [below, above] = [costsOf(kTierNames[i - 1]!), costsOf(kTierNames[i]!)];
      above.forEach((cost, at) => expect(cost).toBeGreaterThanOrEqual(below[at]!));
      expect(above).not.toEqual(below);
    }
  });

  it("are chosen by the address, or automatically", () => {
    for (const name of kTierNames) expect(chooseQuality(`?room=a&quality=${name}`)).toBe(name);
    for (const search of ["", "?quality=", "?quality=HIGH", "?quality=toString"]) expect(chooseQuality(search)).toBe("automatic");
  });

  it("begin lower without graphics hardware and on a handheld device", () => {
    expect(isSoftware("ANGLE (Google, Vulkan 1.3 (SwiftShader Device))")).toBe(true);
    expect(isSoftware("ANGLE (NVIDIA, GeForce)")).toBe(false);
    const cost = (tier: TierName): number => kTierNames.indexOf(tier);
    expect(cost(firstTier(true, false))).toBeLessThan(cost(firstTier(false, true)));
    expect(cost(firstTier(false, true))).toBeLessThan(cost(firstTier(false, false)));
  });
});

describe("the automatic quality", () => {
  it("falls to the lowest tier within seconds while pictures are slow, and stays there", () => {
    const governor = new QualityGovernor("high", "automatic");
    draw(governor, 80, 20_000);
    expect(governor.tier).toBe("minimal");
    expect(draw(governor, 80, 60_000)).toBe(0);
    expect(governor.resolutionShare).toBe(1);
  });

  it("gives up sharpness of the lowest tier only for ten pictures per second", () => {
    const governor = new QualityGovernor("high", "automatic");
    draw(governor, (tier) => (tier === "minimal" ? 120 : 3000), 60_000);
    expect([governor.tier, governor.resolutionShare]).toEqual(["minimal", 0.75]);
    expect(draw(governor, 200, 60_000)).toBe(0);
    // A busy moment, as at the start of a page, does not cost the sharpness for good.
    draw(governor, () => (governor.resolutionShare < 1 ? 55 : 90), 60_000);
    expect([governor.tier, governor.resolutionShare]).toEqual(["minimal", 1]);
  });

  it("lowers the resolution before it lowers the tier", () => {
    const governor = new QualityGovernor("high", "automatic");
    const before = governor.pixelRatio(1);
    while (!governor.note(50));
    expect(governor.tier).toBe("high");
    expect(governor.pixelRatio(1)).toBeCloseTo(0.75 * before, 9);
    while (!governor.note(50));
    expect(governor.tier).toBe("medium");
    expect(governor.resolutionShare).toBe(1);
  });

  it("falls by several rungs at once where pictures take seconds", () => {
    const governor = new QualityGovernor("high", "automatic");
    expect(draw(governor, 900, 7000)).toBe(1);
    expect(governor.tier).toBe("low");
    // Pictures of several seconds are not taken for pauses.
    const slower = new QualityGovernor("high", "automatic");
    draw(slower, 3000, 30_000);
    expect(slower.tier).toBe("minimal");
  });

  it("ignores single slow pictures and pauses", () => {
    const governor = new QualityGovernor("medium", "automatic");
    for (let i = 0; i < 400; ++i) expect(governor.note(i % 2 ? 80 : 25)).toBe(false);
    for (let i = 0; i < 10; ++i) {
      expect(governor.note(60_000)).toBe(false);
      expect(governor.note(25)).toBe(false);
    }
  });

  it("rises while pictures are fast, to the highest tier", () => {
    const governor = new QualityGovernor("medium", "automatic");
    draw(governor, 16, 60_000);
    expect(governor.tier).toBe("highest");
    expect(governor.resolutionShare).toBe(1);
  });

  it("climbs fast from the cheapest tier on a machine without graphics hardware that carries more, until it falls", () => {
    const governor = new QualityGovernor(firstTier(true, false), "automatic");
    expect(governor.tier).toBe("minimal");
    draw(governor, 16, 5000);
    expect([governor.tier, governor.resolutionShare]).toEqual(["low", 1]);
    expect(draw(governor, 90, 2000)).toBe(1);
    expect(draw(governor, 16, 5000)).toBe(0);
  });

  it("tries a tier that was too slow again, ever more rarely", () => {
    const governor = new QualityGovernor("medium", "automatic");
    const byTier = (tier: TierName): number => (kTierNames.indexOf(tier) > kTierNames.indexOf("medium") ? 45 : 16);
    const changes = Array.from({ length: 5 }, () => draw(governor, byTier, 120_000));
    expect(changes[0]).toBeGreaterThanOrEqual(2);
    expect(changes.at(-1)).toBeLessThanOrEqual(2);
    expect(changes.reduce((sum, count) => sum + count)).toBeLessThan(20);
  });

  it("never changes a tier chosen by hand, nor its resolution", () => {
    const governor = new QualityGovernor("medium", "high");
    expect(draw(governor, 800, 60_000)).toBe(0);
    expect(draw(governor, 8, 60_000)).toBe(0);
    expect(governor.tier).toBe("high");
    governor.choose("low");
    expect(draw(governor, 800, 60_000)).toBe(0);
    expect([governor.tier, governor.resolutionShare]).toEqual(["low", 1]);
    governor.choose("automatic");
    expect(governor.tier).toBe("medium");
    expect(draw(governor, 80, 20_000)).toBeGreaterThan(0);
  });

  it("draws no more pixels than the device or the tier has", () => {
    for (const name of kTierNames) {
      const governor = new QualityGovernor("high", name);
      expect(governor.pixelRatio(0.5)).toBeLessThanOrEqual(0.5);
      expect(governor.pixelRatio(4)).toBe(kTiers[name].maxPixelRatio);
    }
  });
});

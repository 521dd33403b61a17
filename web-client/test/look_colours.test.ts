// Colour maps, ranges and ticks of the looks.
import { describe, expect, it } from "vitest";

import { colourMap, kColoursCount, type ColourMapName } from "../src/scene/looks/colour_map";
import { kNarrowAfterS, niceAbove, RangeFollower, reachOf, ticksOf } from "../src/scene/looks/value_range";

/** Lightness L* of CIELAB, 0..100. */
function lightnesses(name: ColourMapName): number[] {
  const bytes = colourMap(name);
  const linear = (byte: number): number => (byte / 255 <= 0.04045 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4);
  return Array.from({ length: kColoursCount }, (_, i) => {
    const y = 0.2126 * linear(bytes[4 * i]!) + 0.7152 * linear(bytes[4 * i + 1]!) + 0.0722 * linear(bytes[4 * i + 2]!);
    return y > (6 / 29) ** 3 ? 116 * Math.cbrt(y) - 16 : (y * 29 ** 3) / 27;
  });
}

const colourOf = (name: ColourMapName, index: number): string => Buffer.from(colourMap(name).slice(4 * index, 4 * index + 3)).toString("hex");

describe.each(["viridis", "cividis"] as const)("the colour map %s", (name) => {
  it("becomes lighter with every colour, and evenly", () => {
    const steps = lightnesses(name).map((lightness, i, all) => lightness - (all[i - 1] ?? Number.NaN)).slice(1);
    expect(steps).toHaveLength(kColoursCount - 1);
    // Colours are whole bytes, which moves a lightness by up to 0.25.
    for (const step of steps) expect(step).toBeGreaterThan(-0.12);
    for (let i = 0; i + 8 <= steps.length; i += 8) {
      const mean = steps.slice(i, i + 8).reduce((sum, step) => sum + step) / 8;
      expect(mean).toBeGreaterThan(0.2);
      expect(mean).toBeLessThan(0.4);
    }
  });
});

describe("the published colours", () => {
  it("are kept: ends and thirds", () => {
    expect([0, 85, 170, 255].map((index) => colourOf("viridis", index))).toEqual(["440154", "31688e", "35b779", "fde725"]);
    expect([0, 85, 170, 255].map((index) => colourOf("cividis", index))).toEqual(["00224e", "575d6d", "a59c74", "fee838"]);
  });

  it("of Moreland's cool to warm map are its ends and a light grey between them", () => {
    expect(colourOf("coolWarm", 0)).toBe("3b4cc0");
    expect(colourOf("coolWarm", 255)).toBe("b40426");
    const middle = colourMap("coolWarm").slice(4 * 128, 4 * 128 + 3);
    for (const channel of middle) expect(Math.abs(channel - 221)).toBeLessThan(4);
  });
});

describe.each(["coolWarm", "purpleGreen"] as const)("the diverging map %s", (name) => {
  it("becomes lighter up to the middle and darker after it, alike on both sides", () => {
    const all = lightnesses(name);
    for (let i = 1; i < kColoursCount; ++i) expect((all[i]! - all[i - 1]!) * (i < kColoursCount / 2 ? 1 : -1)).toBeGreaterThan(-0.3);
    for (const share of [0.25, 0.45]) {
      const away = Math.round(share * 255);
      expect(Math.abs(all[127 - away]! - all[128 + away]!)).toBeLessThan(16);
    }
    expect(all[127]! - Math.max(all[0]!, all[255]!)).toBeGreaterThan(30);
  });
});

describe("the range of the colours", () => {
  it("ends at 1, 2 or 5 times a power of ten", () => {
    const cases = [[1, 1], [1.01, 2], [2, 2], [2.1, 5], [5.5, 10], [0.13, 0.2], [0.2, 0.2], [0.0021, 0.005], [73, 100]] as const;
    for (const [value, nice] of cases) expect(niceAbove(value)).toBe(nice);
  });

  it("has three to seven ticks at round numbers inside it", () => {
    expect(ticksOf({ low: -1, high: 1 })).toEqual([-1, -0.5, 0, 0.5, 1]);
    expect(ticksOf({ low: -5, high: 5 })).toEqual([-4, -2, 0, 2, 4]);
    expect(ticksOf({ low: 0.5, high: 1.1 })).toEqual([0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.1]);
    for (const limit of [1e-3, 2e-3, 5e-3, 0.01, 0.2, 0.5, 1, 2, 5, 10, 200])
      for (const low of [0, -limit]) {
        const ticks = ticksOf({ low, high: limit });
        expect(ticks.length).toBeGreaterThanOrEqual(3);
        expect(ticks.length).toBeLessThanOrEqual(7);
        for (const tick of ticks) expect(tick >= low - 1e-12 && tick <= limit + 1e-12).toBe(true);
        expect(ticks).toContain(0);
      }
  });

  it("leaves out a small share of the values", () => {
    const magnitudes = Float64Array.from({ length: 1000 }, (_, i) => i + 1);
    expect(reachOf(magnitudes, 0, 0.01)).toBe(990);
    expect(reachOf(new Float64Array(0), 0, 0.01)).toBe(0);
  });

  it("follows what moves: a small splash in still water counts, the still water does not", () => {
    const magnitudes = Float64Array.from({ length: 4096 }, (_, i) => (i < 40 ? 0.3 : 1e-4));
    expect(reachOf(magnitudes, 0.01, 0.1)).toBe(0.3);
    expect(reachOf(new Float64Array(100).fill(1e-4), 0.01, 0.1)).toBe(0);
  });

  it("widens at once, and narrows only after values have been smaller for a while", () => {
    const follower = new RangeFollower(true);
    expect(follower.range).toEqual({ low: -1, high: 1 });
    expect(follower.note(0.3, 0.01, 0)).toBe(true);
    expect(follower.range).toEqual({ low: -0.5, high: 0.5 });
    expect(follower.note(0.7, 0.01, 1)).toBe(true);
    expect(follower.range.high).toBe(1);
    expect(follower.note(0.1, 0.01, 2)).toBe(false);
    // A larger value in between counts.
    expect(follower.note(0.3, 0.01, 2 + kNarrowAfterS / 2)).toBe(false);
    expect(follower.note(0.1, 0.01, 2 + kNarrowAfterS)).toBe(true);
    expect(follower.range.high).toBe(0.5);
  });

  it("never becomes narrower than the steps of the stream", () => {
    const follower = new RangeFollower(false);
    follower.note(0, 0.03, 0);
    expect(follower.range).toEqual({ low: 0, high: 0.05 });
  });
});

import { describe, expect, it } from "vitest";

import type { EffectLimits } from "../src/ui/effect_limits";
import { linesOf, streaksOf } from "../src/ui/tool_preview";
import { heldRatio, kTools, paddleWave, splashOf, strokeSize } from "../src/ui/tools";

const kWater = { waterExtents: { sideM: 20, longM: 40, depthM: 2 } };
const kPlain = { sizeRatio: 1, strengthRatio: 1 };
const tool = (name: string) => kTools.find((each) => each.name === name)!;
const range = (min: number, max: number) => ({ label: "", unit: "m", min, max, step: 0.01, default: 1 });
const kLimits: EffectLimits = { splashRadiusM: range(0.05, 10), splashDepthM: range(0.01, 1.8), waveAmplitudeM: range(0.01, 1.8), waveLengthM: range(0.1, 20), waveDirectionDeg: range(-180, 180) };

describe("tools", () => {
  it("draw strokes that the server takes, at every size: at most an eighth of the side, a quarter for discs, a third of the depth, half the radius", () => {
    for (const each of kTools) {
      for (const sizeRatio of [0.4, 1, 2.5]) {
        const size = strokeSize(each, kWater, { sizeRatio, strengthRatio: 1 });
        if (each.stroke === undefined) {
          expect(size).toBeUndefined();
          continue;
        }
        expect(size!.radiusM).toBeLessThanOrEqual((each.name === "finger" ? 0.125 : 0.25) * 20);
        expect(size!.depthM).toBeLessThanOrEqual(Math.min(2 / 3, 0.5 * size!.radiusM));
        expect(size!.tool).toBe(each.stroke);
      }
    }
    expect(strokeSize(tool("rain"), kWater, kPlain)!.radiusM).toBeCloseTo(2, 9);
  });

  it("make a splash larger the longer it is held, within the limits of the water", () => {
    expect([-1, 0, 0.75, 1.5, 9].map(heldRatio)).toEqual([1, 1, 1.75, 2.5, 2.5]);
    const size = { splashRadiusM: 1.5, splashDepthM: 0.8 };
    expect(splashOf({ xM: 1, zM: 2 }, size, kLimits, { sizeRatio: 2, strengthRatio: 0.5 })).toEqual({ case: "splash", value: { xM: 1, zM: 2, radiusM: 3, depthM: 0.8 } });
    expect(splashOf({ xM: 1, zM: 2 }, size, kLimits, { sizeRatio: 9, strengthRatio: 1 })).toMatchObject({ value: { radiusM: 10, depthM: 1.8 } });
  });

  it("send a paddle's wave the way of the drag, from where it ends, higher after a longer drag", () => {
    const wave = (toX: number, toZ: number, strengthRatio = 1) => paddleWave({ xM: 1, zM: 1 }, { xM: toX, zM: toZ }, kWater, { sizeRatio: 1, strengthRatio })?.value as Record<string, number>;
    expect(wave(1, 1.1)).toBeUndefined();
    expect(wave(1, 4)).toMatchObject({ directionDeg: 90, xM: 1, zM: 4, widthM: 6, lengthM: 2 });
    expect(wave(-2, 1).directionDeg).toBe(180);
    expect(wave(1, 4).amplitudeM).toBeLessThan(wave(1, 7).amplitudeM!);
    expect(wave(1, 8.5).amplitudeM).toBeCloseTo(0.5, 9);
    expect(wave(1, 9, 0.5).amplitudeM).toBeCloseTo(0.25, 9);
    // Where there are ripples, one of them; 1.71 cm in water.
    const tank = { waterExtents: { sideM: 0.45, longM: 0.45, depthM: 0.05, rippleM: 0.0171 } };
    expect(paddleWave({ xM: 0, zM: 0 }, { xM: 0.2, zM: 0 }, tank, kPlain)?.value).toMatchObject({ lengthM: 0.0171, amplitudeM: 0.25 * 0.0171, widthM: 0.3 * 0.45 });
  });

  it("are outlined on the water: a closed circle; a paddle across the drag, with an arrow", () => {
    const [circle] = linesOf({ kind: "disc", at: { xM: 3, zM: -1 }, radiusM: 2, color: "" });
    expect(circle!.at(-1)!.xM).toBeCloseTo(circle![0]!.xM, 9);
    for (const { xM, zM } of circle!) expect(Math.hypot(xM - 3, zM + 1)).toBeCloseTo(2, 9);
    const [paddle, arrow] = linesOf({ kind: "paddle", from: { xM: 0, zM: 0 }, to: { xM: 2, zM: 0 }, widthM: 3, color: "" });
    expect(paddle).toEqual([{ xM: 2, zM: 1.5 * -1 }, { xM: 2, zM: 1.5 }]);
    expect(arrow).toEqual([{ xM: 0, zM: 0 }, { xM: 2, zM: 0 }]);
    expect(linesOf({ kind: "paddle", from: { xM: 1, zM: 1 }, to: { xM: 1, zM: 1 }, widthM: 3, color: "" })).toEqual([]);
    for (const [low, high] of streaksOf({ at: { xM: 3, zM: -1 }, radiusM: 2 }, Math.random)) {
      expect(Math.hypot(low!.xM - 3, low!.zM + 1)).toBeLessThanOrEqual(2);
      expect(high).toEqual({ ...low, aboveM: low!.aboveM! + 0.5 });
    }
  });
});

import { getOption } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";

import { parse } from "../client/codec/parse";
import { kDebounceMs, SliderModel } from "../src/ui/slider_model";
import { clampTo, effectLimits, keptValue } from "../src/ui/effect_limits";
import { parameter, type ParameterOptions } from "../client/gen/spindrift/v1/options_pb";
import { BreakingWaveSchema, SplashSchema } from "../client/gen/spindrift/v1/scene_pb";
import { FakeTime } from "./fakes";
import { encode, greeting } from "./wire";

function rig(serverValue = 40) {
  const time = new FakeTime();
  const sent: number[] = [];
  let changedCount = 0;
  const model = new SliderModel(serverValue, {
    send: (value) => sent.push(value),
    setTimer: (callback, ms) => time.setTimer(callback, ms),
    clearTimer: (timer) => time.clearTimer(timer),
    changed: () => ++changedCount,
  });
  return { time, sent, model, changedCount: () => changedCount };
}

describe("a parameter's slider", () => {
  it("sends only the value at which it rests", () => {
    const { time, sent, model } = rig();
    for (const value of [41, 42, 43, 44]) {
      model.input(value);
      time.advance(kDebounceMs - 1);
    }
    expect(sent).toEqual([]);
    time.advance(1);
    expect(sent).toEqual([44]);
    time.advance(1000);
    expect(sent).toEqual([44]);
  });

  it("returns to the server's value after a reject and shows the reason", () => {
    const { time, model } = rig(40);
    model.input(400);
    time.advance(kDebounceMs);
    expect(model.shownValue).toBe(400);
    expect(model.reject(1, "400 Pa s breaks the step rule")).toBe(true);
    expect(model).toMatchObject({ shownValue: 40, error: "400 Pa s breaks the step rule" });
    model.input(50);
    expect(model.error).toBe("");
  });

  it("returns to the last accepted value", () => {
    const { time, model } = rig(40);
    model.input(60);
    time.advance(kDebounceMs);
    expect(model.ack(1)).toBe(true);
    model.input(400);
    time.advance(kDebounceMs);
    model.reject(2, "no");
    expect(model.shownValue).toBe(60);
  });

  it("ignores the reject of a value that the user has changed since", () => {
    const { time, model } = rig(40);
    model.input(400);
    time.advance(kDebounceMs);
    model.input(80);
    model.reject(1, "no");
    expect(model).toMatchObject({ shownValue: 80, error: "" });
  });

  it("follows another person's change, but not while it is being moved", () => {
    const { time, model, changedCount } = rig(40);
    model.setServerValue(70);
    expect(model.shownValue).toBe(70);
    expect(changedCount()).toBe(1);
    model.input(90);
    model.setServerValue(75);
    expect(model.shownValue).toBe(90);
    time.advance(kDebounceMs);
    model.reject(1, "no");
    expect(model.shownValue).toBe(75);
  });

  it("ignores answers to other sliders and sends nothing after dispose", () => {
    const { time, sent, model } = rig();
    expect(model.ack(5)).toBe(false);
    expect(model.reject(5, "no")).toBe(false);
    model.input(41);
    model.dispose();
    time.advance(1000);
    expect(sent).toEqual([]);
  });
});

describe("the effect sliders' ranges", () => {
  const enter = (scene: Record<string, unknown>) => {
    const parsed = parse(encode(greeting({ scene })));
    if (parsed.kind !== "greeting") throw new Error(parsed.kind);
    return effectLimits(parsed.greeting);
  };

  it("come from the options in the proto, narrowed to the water", () => {
    const limits = enter({ wave: { resolutionCount: 256, sideM: 16, depthM: 1.5 } })!;
    // The steps of the options are for the smallest water.
    const optionsOf = ({ label, unit, default: fallback }: ParameterOptions, step: number) => ({ label, unit, min: step, step, default: fallback });
    const { field: splash } = SplashSchema;
    const { field: wave } = BreakingWaveSchema;
    expect(limits).toEqual({
      splashRadiusM: { ...optionsOf(getOption(splash.radiusM, parameter), 0.05), max: 8 },
      splashDepthM: { ...optionsOf(getOption(splash.depthM, parameter), 0.01), max: 1.35 },
      waveAmplitudeM: { ...optionsOf(getOption(wave.amplitudeM, parameter), 0.01), max: 1.35 },
      waveLengthM: { ...optionsOf(getOption(wave.lengthM, parameter), 0.05), max: 16 },
      waveDirectionDeg: { ...optionsOf(getOption(wave.directionDeg, parameter), 1), min: -180, max: 180 },
    });
    expect(limits.splashRadiusM.label).toBe("Splash radius");
  });

  it("limit the default in shallow and small water, and keep the proto's bound in wide water", () => {
    const small = enter({ wave: { resolutionCount: 64, sideM: 1, depthM: 0.2 } })!;
    expect(small.splashRadiusM).toMatchObject({ max: 0.5, default: 0.1 });
    expect(small.splashDepthM).toMatchObject({ max: 0.18, default: 0.055 });
    expect(small.waveLengthM).toMatchObject({ max: 1, default: 0.2 });
    expect(small.waveAmplitudeM).toMatchObject({ max: 0.18, default: 0.04 });
    expect(enter({ wave: { resolutionCount: 64, sideM: 1000, depthM: 100 } })!.splashRadiusM.max).toBe(100);
    expect(clampTo(3, small.splashRadiusM)).toBe(0.5);
  });

  it("are of the size of ripples where the water has surface tension, and a chosen size stays in proportion", () => {
    const wave = { resolutionCount: 160, sideM: 0.45, depthM: 0.05 };
    const tank = enter({ gravityMps2: 9.81, wave: { ...wave, surfaceTensionNpm: 0.0728 } })!;
    // The slowest ripples of water have 1.71 cm.
    expect(tank.splashRadiusM).toMatchObject({ min: 0.005, step: 0.005, max: 0.225, default: 0.01 });
    expect(tank.splashDepthM).toMatchObject({ min: 0.0001, max: 0.045, default: 0.0055 });
    expect(tank.waveLengthM).toMatchObject({ min: 0.01, max: 0.45, default: 0.015 });
    expect(tank.waveAmplitudeM.default).toBeCloseTo(0.003, 9);
    expect(enter({ gravityMps2: 9.81, wave })!.splashRadiusM.default).toBe(0.045);
    const pool = enter({ wave: { resolutionCount: 64, sideM: 20, depthM: 2 } })!;
    expect(keptValue(3, pool.splashRadiusM, tank.splashRadiusM)).toBeCloseTo(0.02, 9);
    expect(keptValue(0.02, tank.splashRadiusM, pool.splashRadiusM)).toBeCloseTo(3, 9);
    expect(keptValue(9, pool.splashDepthM, tank.splashDepthM)).toBe(0.045);
    expect(keptValue(90, pool.waveDirectionDeg, tank.waveDirectionDeg)).toBe(90);
  });

  it("follow from the narrower side and the resting depth of a box of particles, as in the server", () => {
    // 2 layers of 8 particles at 0.5 m: a metre of water.
    const limits = enter({ particles: { boxSideM: 4, boxWidthM: 2, fillXRatio: 0.5, fillZRatio: 1, layersCount: 2, count: 32 } })!;
    expect(limits.splashRadiusM.max).toBe(1);
    expect(limits.splashDepthM.max).toBe(0.9);
    expect(limits.waveLengthM.max).toBe(2);
  });

  it("are undefined for water without a depth", () => {
    expect(enter({ particles: { boxSideM: 2.4 } })).toBeUndefined();
  });
});

import { getOption, type DescField } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";

import type { GreetingInfo } from "../client/codec/greeting";
import { parameter } from "../client/gen/spindrift/v1/options_pb";
import { BoatSchema } from "../client/gen/spindrift/v1/scene_pb";
import { SetSpeedSchema } from "../client/gen/spindrift/v1/wire_pb";
import { boatLimits, boatOfLength, effectLimits, speedRange } from "../src/ui/effect_limits";
import { Helm, helmKey } from "../src/ui/helm";
import { LatestSender } from "../src/ui/latest_sender";
import { FakeTime } from "./fakes";

function sender() {
  const time = new FakeTime();
  const sent: [value: number, atMs: number][] = [];
  const world = { nowMs: () => time.nowMs, setTimer: time.setTimer.bind(time), clearTimer: time.clearTimer.bind(time) };
  return { time, sent, sender: new LatestSender<number>((value) => sent.push([value, time.nowMs]), world, 50) };
}

describe("helm commands", () => {
  it("are sent at most twenty times per second, the first at once and the last always", () => {
    const rig = sender();
    for (let ms = 0; ms < 1000; ms += 5) {
      rig.sender.offer(ms);
      rig.time.advance(5);
    }
    rig.time.advance(500);
    expect(rig.sent[0]).toEqual([0, 1000]);
    expect(rig.sent.length).toBeLessThanOrEqual(21);
    expect(rig.sent.length).toBeGreaterThan(15);
    expect(rig.sent.at(-1)![0]).toBe(995);
    for (let i = 1; i < rig.sent.length; ++i) expect(rig.sent[i]![1] - rig.sent[i - 1]![1]).toBeGreaterThanOrEqual(50);
    expect(rig.time.timerCount).toBe(0);
  });

  it("are sent at once when flushed and never when cancelled", () => {
    const rig = sender();
    rig.sender.offer(1);
    rig.sender.offer(2);
    rig.sender.flush();
    rig.sender.offer(3);
    rig.sender.cancel();
    rig.sender.flush();
    rig.time.advance(1000);
    expect(rig.sent.map(([value]) => value)).toEqual([1, 2]);
    expect(rig.time.timerCount).toBe(0);
  });
});

describe("the helm", () => {
  it("uses arrows and WASD by their physical position", () => {
    expect(["ArrowUp", "KeyW", "ArrowDown", "KeyS", "ArrowLeft", "KeyA", "ArrowRight", "KeyD", "Space"].map(helmKey)).toEqual([
      "ahead", "ahead", "astern", "astern", "port", "port", "starboard", "starboard", undefined,
    ]);
  });

  it("moves the throttle while its key is held and keeps it afterwards", () => {
    const helm = new Helm();
    helm.press("ahead");
    for (let i = 0; i < 100; ++i) helm.advance(0.016);
    expect(helm.throttle).toBe(1);
    helm.release("ahead");
    expect(helm.advance(1)).toBe(false);
    expect(helm.throttle).toBe(1);
    helm.press("astern");
    helm.advance(0.5);
    expect(helm.throttle).toBeCloseTo(0.3, 9);
  });

  it("centres the rudder when its keys are released, but not after its slider was used", () => {
    const helm = new Helm();
    helm.press("port");
    helm.advance(0.1);
    expect(helm.rudder).toBeCloseTo(-0.4, 9);
    helm.release("port");
    helm.advance(1);
    expect(helm.rudder).toBe(0);
    helm.setRudder(0.5);
    expect(helm.advance(1)).toBe(false);
    expect(helm.rudder).toBe(0.5);
  });

  it("ignores two opposite keys, and releases every key when centred", () => {
    const helm = new Helm();
    for (const key of ["ahead", "astern"] as const) helm.press(key);
    expect(helm.advance(1)).toBe(false);
    helm.centre();
    helm.press("ahead");
    helm.centre();
    expect(helm.advance(1)).toBe(false);
    expect([helm.throttle, helm.rudder]).toEqual([0, 0]);
  });
});

describe("limits from the scene", () => {
  const defaultOf = (field: DescField): number => getOption(field, parameter).default;
  const wave = { resolutionCount: 256, sideM: 24, depthM: 1.5, periodicX: true, periodicZ: true };
  const greeting = (change: Partial<GreetingInfo>) => ({ wave, waterExtents: { ...wave, longM: 24 }, hasBoats: true, ...change }) as GreetingInfo;

  it("allow waves from every direction", () => {
    expect(effectLimits(greeting({}))!.waveDirectionDeg).toMatchObject({ min: -180, max: 180, step: 1 });
  });

  it("keep boats afloat: no longer than a quarter of the side, nor deeper than the water", () => {
    expect(boatLimits(greeting({}))!.lengthM).toMatchObject({ min: 0.3, max: 6, default: defaultOf(BoatSchema.field.lengthM) });
    const shallow = boatLimits(greeting({ waterExtents: { sideM: 24, longM: 24, depthM: 0.2 } }))!.lengthM;
    expect(boatOfLength(shallow.max).draughtM).toBeLessThanOrEqual(0.6 * 0.2 + 1e-9);
    expect(boatLimits(greeting({ hasBoats: false }))).toBeUndefined();
    expect(boatLimits(greeting({ waterExtents: { sideM: 24, longM: 24, depthM: 0 } }))).toBeUndefined();
    const canal = boatLimits(greeting({ waterExtents: { sideM: 4, longM: 40, depthM: 3 } }))!.lengthM;
    expect(canal.max, "half of a canal's width").toBe(2);
    expect(boatLimits(greeting({}))!.throttleRatio).toMatchObject({ min: -1, max: 1 });
  });

  it("give boats the shape of the proto's default boat", () => {
    const { field } = BoatSchema;
    const boat = boatOfLength(defaultOf(field.lengthM));
    expect(boat.beamM).toBeCloseTo(defaultOf(field.beamM), 9);
    expect(boat.heightM).toBeCloseTo(defaultOf(field.heightM), 9);
    expect(boat.densityRatio).toBe(defaultOf(field.densityRatio));
    expect(boatOfLength(2 * defaultOf(field.lengthM)).beamM).toBeCloseTo(2 * defaultOf(field.beamM), 9);
  });

  it("give time the range of the proto", () => {
    expect(speedRange()).toMatchObject({ min: 0.1, max: 4, default: defaultOf(SetSpeedSchema.field.speed) });
  });
});

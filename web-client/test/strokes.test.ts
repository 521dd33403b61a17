import { describe, expect, it } from "vitest";

import { create, toBinary } from "@bufbuild/protobuf";

import { parse } from "../client/codec/parse";
import { ServerMessageSchema, StrokeTool } from "../client/gen/spindrift/v1/wire_pb";
import { LocalRipple } from "../src/scene/water/local_ripple";
import { StrokeSender, type StrokeMessage } from "../src/ui/stroke_sender";
import { World } from "./fakes";

const kSize = { tool: StrokeTool.FINGER, radiusM: 0.5, depthM: 0.1 };
const at = (timeMs: number, xM: number) => ({ timeMs, xM, zM: 0, pressureRatio: 1 });

describe("StrokeSender", () => {
  const begin = () => {
    const world = new World();
    const sent: StrokeMessage[] = [];
    return { world, sent, sender: new StrokeSender((message) => sent.push(message), world) };
  };

  it("sends the beginning at once and then one message per interval with all points", () => {
    const { world, sent, sender } = begin();
    sender.begin(1, [at(1000, 0), at(1010, 0.1)], kSize);
    expect(sent).toHaveLength(1);
    expect(sent[0]).toMatchObject({ strokeId: 1, radiusM: 0.5, depthM: 0.1 });
    for (let k = 2; k <= 12; ++k) {
      world.pass(10);
      sender.move(1, at(1000 + 10 * k, 0.1 * k));
    }
    expect(sent.length).toBeGreaterThanOrEqual(3);
    expect(sent.length).toBeLessThanOrEqual(5);
    sender.end(1);
    const times = sent.flatMap(({ points }) => (points ?? []).map(({ timeS }) => timeS!));
    expect(times).toHaveLength(13);
    times.forEach((timeS, k) => expect(timeS).toBeCloseTo(0.01 * k, 9));
    expect(sent.at(-1)!.ends).toBe(true);
    const countAtEnd = sent.length;
    world.pass(5000);
    expect(sent).toHaveLength(countAtEnd);
  });

  it("is heard of while a finger rests, more often than the server's patience", () => {
    const { world, sent, sender } = begin();
    sender.begin(1, [at(0, 0.5)], kSize);
    world.pass(5000);
    expect(sent.length).toBeGreaterThanOrEqual(5);
    expect(sent.length).toBeLessThanOrEqual(9);
    for (const { points } of sent) expect(points!.at(-1)).toMatchObject({ xM: 0.5 });
  });

  it("keeps ten fingers within the commands that the server takes from a session", () => {
    const { world, sent, sender } = begin();
    for (let id = 0; id < 10; ++id) sender.begin(id, [at(0, id)], kSize);
    for (let ms = 5; ms <= 10_000; ms += 5) {
      world.pass(5);
      for (let id = 0; id < 10; ++id) sender.move(id, at(ms, id + ms));
    }
    expect(sent.length).toBeGreaterThan(1000);
    expect(sent.length).toBeLessThan(1500);
  });

  it("gives each finger a number and ends them", () => {
    const { sent, sender } = begin();
    sender.begin(7, [at(0, 0)], kSize);
    sender.begin(8, [at(0, 1)], kSize);
    for (const pointerId of [7, 8]) sender.end(pointerId);
    expect(sent.map(({ strokeId, ends }) => [strokeId, ends ?? false])).toEqual([[1, false], [2, false], [1, true], [2, true]]);
  });

  it("keeps messages within the server's limit and points apart in time", () => {
    const { world, sent, sender } = begin();
    sender.begin(1, [at(0, 0)], kSize);
    for (let k = 1; k <= 1000; ++k) sender.move(1, at(0.5 * k, k));
    world.pass(40);
    for (const { points } of sent) expect(points!.length).toBeLessThanOrEqual(64);
    const times = sent.flatMap(({ points }) => points!.map(({ timeS }) => timeS!));
    for (let k = 1; k < times.length; ++k) expect(times[k]! - times[k - 1]!).toBeGreaterThanOrEqual(0.004 - 1e-9);
  });
});

describe("LocalRipple", () => {
  const depth = (ripple: LocalRipple): number => ripple.dents.value.slice(0, ripple.count.value).reduce((sum, { w }) => sum - w, 0);

  it("is there within a picture of the press, and reaches back to where the shown water takes over", () => {
    const ripple = new LocalRipple();
    ripple.press(1, 0, 0, kSize, 10);
    ripple.update(10.03, 0.2);
    expect(depth(ripple)).toBeGreaterThan(0.5 * kSize.depthM);
    for (let k = 1; k <= 50; ++k) ripple.move(1, 0.01 * k, 0, 10 + 0.01 * k);
    ripple.update(10.5, 0.2);
    expect(depth(ripple)).toBeCloseTo(kSize.depthM, 6);
    const xs = ripple.dents.value.slice(0, ripple.count.value).map(({ x }) => x);
    expect(xs[0]).toBeCloseTo(0.5, 6);
    expect(Math.min(...xs)).toBeCloseTo(0.35, 6);
  });

  it("goes without a jump when the finger rests or is lifted", () => {
    const ripple = new LocalRipple();
    ripple.press(1, 0, 0, kSize, 0);
    ripple.update(0.2, 0.2);
    let before = depth(ripple);
    ripple.lift(1, 0.2);
    for (let s = 0.21; s < 1; s += 0.01) {
      ripple.update(s, 0.2);
      expect(before - depth(ripple)).toBeLessThan(0.1 * kSize.depthM);
      before = depth(ripple);
    }
    expect(ripple.count.value).toBe(0);
    expect(ripple.down().size).toBe(0);
  });

  it("draws no more dents than the shader takes", () => {
    const ripple = new LocalRipple();
    for (let id = 0; id < 10; ++id) ripple.press(id, id, 0, kSize, 0);
    ripple.update(0.1, 0.2);
    expect(ripple.count.value).toBe(16);
    expect(ripple.down().size).toBe(10);
  });
});

describe("strokes of the server", () => {
  const bytes = (xM: number): ArrayBuffer => {
    const message = create(ServerMessageSchema, { message: { case: "strokes", value: { timeS: 2, fingers: [{ personId: 3, strokeId: 4, xM, zM: 1, radiusM: 0.5, tool: StrokeTool.RAIN }] } } });
    return toBinary(ServerMessageSchema, message).slice().buffer;
  };
  it("are read", () => expect(parse(bytes(1.5))).toEqual({ kind: "strokes", fingers: [{ personId: 3, strokeId: 4, xM: 1.5, zM: 1, radiusM: 0.5, tool: StrokeTool.RAIN }] }));
  it("are malformed with a number that is not finite", () => expect(parse(bytes(Number.NaN)).kind).toBe("malformed"));
});

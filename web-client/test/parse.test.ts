import { describe, expect, it } from "vitest";

import { crc32c } from "../src/codec/crc32c";
import { kMaxParticleCount, parse } from "../src/codec/parse";
import { Layer, RejectReason } from "../src/gen/spindrift/v1/wire_pb";
import { encode, greeting, particleFrame, surfaceFrame } from "./wire";

function expectMalformed(buffer: ArrayBuffer, reason: RegExp): void {
  const parsed = parse(buffer);
  expect(parsed.kind).toBe("malformed");
  expect(parsed.kind === "malformed" && parsed.reason).toMatch(reason);
}

describe("crc32c", () => {
  it("gives the known answer for 123456789", () => {
    expect(crc32c(new TextEncoder().encode("123456789"))).toBe(0xe3069283);
  });
  it("agrees with the bit-by-bit definition at every length and offset", () => {
    const bytes = Uint8Array.from({ length: 61 }, (_, i) => (i * 73 + 11) & 255);
    for (let from = 0; from < 5; ++from)
      for (let to = from; to <= bytes.length; ++to) {
        let crc = 0xffffffff;
        for (const byte of bytes.subarray(from, to)) {
          crc ^= byte;
          for (let bit = 0; bit < 8; ++bit) crc = crc & 1 ? (crc >>> 1) ^ 0x82f63b78 : crc >>> 1;
        }
        expect(crc32c(bytes.subarray(from, to))).toBe(~crc >>> 0);
      }
  });
});

describe("parse", () => {
  it("reads a greeting into plain data that can be cloned", () => {
    const parsed = parse(encode(greeting()));
    if (parsed.kind !== "greeting") throw new Error(parsed.kind);
    expect(structuredClone(parsed.greeting)).toMatchObject({
      versionMajor: 1, room: "pool", device: "a device", title: "Splash pool", sessionId: "5",
      layers: ["surface", "particles", "diagnostics"], sideM: 16, hasParticles: true, paused: true, speed: 0.5,
      wave: { resolutionCount: 256, sideM: 16, depthM: 1.5, periodic: true },
      parameters: [{ path: "particles.viscosity_pas", value: 55, min: 0, max: 500, step: 1 }],
    });
  });

  it("takes the box's side as the water's side where there is no wave", () => {
    const parsed = parse(encode(greeting({ scene: { particles: { boxSideM: 2.4 } } })));
    expect(parsed).toMatchObject({ kind: "greeting", greeting: { wave: undefined, sideM: 2.4 } });
  });

  it("refuses a greeting whose water has no size", () => {
    expectMalformed(encode(greeting({ scene: { wave: { resolutionCount: 256, sideM: 0, depthM: 1 } } })), /side of the water/);
    expectMalformed(encode(greeting({ scene: { wave: { resolutionCount: 256, sideM: 16, depthM: Number.NaN } } })), /depth_m/);
  });

  it("leaves out parameters that no slider can show", () => {
    const bad = { path: "a", label: "", unit: "", min: 0, max: Number.POSITIVE_INFINITY, step: 1, default: 0, value: 0, help: "" };
    const parsed = parse(encode(greeting({ parameters: [bad] })));
    expect(parsed).toMatchObject({ kind: "greeting", greeting: { parameters: [] } });
  });

  it("reads a surface as a view into the message", () => {
    const buffer = encode(surfaceFrame([0, 1, -2, 32767]));
    const parsed = parse(buffer);
    if (parsed.kind !== "surface") throw new Error(parsed.kind);
    expect(parsed.header).toEqual({ tick: 7n, timeS: 0.25, resolutionCount: 2, sideM: 16, quantumM: 0.001 });
    expect(parsed.payload.buffer).toBe(buffer);
    expect([...new Int16Array(parsed.payload.slice().buffer)]).toEqual([0, 1, -2, 32767]);
  });

  it("reads particles with their bounds", () => {
    const parsed = parse(encode(particleFrame(Uint8Array.from({ length: 24 }, (_, i) => i))));
    if (parsed.kind !== "particles") throw new Error(parsed.kind);
    expect(parsed.header).toEqual({ tick: 8n, timeS: 0.5, count: 2, minM: [-8, -1.5, -8], maxM: [8, 5, 8], maxSpeedMps: 9, radiusM: 0.15 });
    expect(parsed.payload.length).toBe(24);
  });

  it("reads every kind of small message", () => {
    expect(parse(encode({ case: "ack", value: { commandId: 3n, appliedTick: 99n } }))).toEqual({ kind: "ack", commandId: 3n, appliedTick: 99n });
    expect(
      parse(encode({ case: "reject", value: { commandId: 4n, reason: RejectReason.OUT_OF_RANGE, field: "splash.radius_m", message: "too wide" } })),
    ).toEqual({ kind: "reject", commandId: 4n, reason: "OUT_OF_RANGE", field: "splash.radius_m", message: "too wide" });
    expect(parse(encode({ case: "parameterChanged", value: { path: "p", value: 2, appliedTick: 5n } }))).toEqual({ kind: "parameterChanged", path: "p", value: 2, appliedTick: 5n });
    expect(parse(encode({ case: "roomState", value: { paused: true, speed: 2 } }))).toEqual({ kind: "roomState", paused: true, speed: 2 });
    expect(parse(encode({ case: "pong", value: { clientTimeS: 1, serverTimeS: 2 } }))).toEqual({ kind: "pong", clientTimeS: 1, serverTimeS: 2 });
    expect(parse(encode({ case: "refusal", value: { message: "no" } }))).toEqual({ kind: "refusal", message: "no" });
    const parsed = parse(encode({ case: "diagnostics", value: { tick: 6n, stepMs: 4.5, nonfiniteCount: 1n, passes: [{ name: "sph", ms: 3 }] } }));
    expect(parsed).toMatchObject({ kind: "diagnostics", diagnostics: { tick: 6n, stepMs: 4.5, nonfiniteCount: 1n, passes: [{ name: "sph", ms: 3 }] } });
    expect(() => structuredClone(parsed)).not.toThrow();
  });

  it("ignores an empty message and a kind it does not know", () => {
    expect(parse(new ArrayBuffer(0)).kind).toBe("unknown");
    expect(parse(Uint8Array.of(0x7a, 0x01, 0x00).buffer).kind).toBe("unknown");
  });

  it("refuses frames whose payload does not fit their header", () => {
    expectMalformed(encode(surfaceFrame([0, 0, 0, 0], { payload: new Uint8Array(6) })), /payload of 6 bytes, header says 8/);
    expectMalformed(encode(particleFrame(new Uint8Array(24), {}, { count: 3 })), /payload of 24 bytes, header says 36/);
    expectMalformed(encode(particleFrame(new Uint8Array(0), {}, { count: kMaxParticleCount + 1 })), /at most/);
    expectMalformed(encode(surfaceFrame([0, 0, 0, 0], { codec: { case: "surfaceFixed16", value: { resolutionCount: 5000, sideM: 1, quantumM: 1 } } as never })), /5000 samples/);
  });

  it("refuses a wrong checksum, a predicted frame, a foreign layer and an unknown codec", () => {
    expectMalformed(encode(surfaceFrame([1, 2, 3, 4], { crc32c: 1 })), /crc32c/);
    expectMalformed(encode(surfaceFrame([1, 2, 3, 4], { keyframe: false })), /keyframes/);
    expectMalformed(encode(surfaceFrame([1, 2, 3, 4], { layer: Layer.PARTICLES })), /carries a surface/);
    expectMalformed(encode(particleFrame(new Uint8Array(12), { layer: Layer.SURFACE })), /carries particles/);
    expectMalformed(encode(surfaceFrame([1, 2, 3, 4], { codec: { case: undefined } })), /codec/);
  });

  it("refuses numbers that would spoil the picture", () => {
    const { NaN: nan, POSITIVE_INFINITY: infinite } = Number;
    expectMalformed(encode(surfaceFrame([1, 2, 3, 4], { timeS: nan })), /time_s/);
    for (const [sideM, quantumM] of [[0, 1], [1, 0], [nan, 1], [1, infinite], [-1, 1]] as const)
      expectMalformed(encode(surfaceFrame([1, 2, 3, 4], { codec: { case: "surfaceFixed16", value: { resolutionCount: 2, sideM, quantumM } } as never })), /above 0/);
    const one = new Uint8Array(12);
    for (const codec of [{ minXM: nan }, { maxYM: infinite }, { minZM: 9 }]) expectMalformed(encode(particleFrame(one, {}, codec)), /bounds/);
    for (const codec of [{ maxSpeedMps: -1 }, { maxSpeedMps: infinite }]) expectMalformed(encode(particleFrame(one, {}, codec)), /speed/);
    for (const codec of [{ radiusM: 0 }, { radiusM: nan }]) expectMalformed(encode(particleFrame(one, {}, codec)), /radius/);
  });

  it("survives every truncation and every flipped byte of a frame without an exception", () => {
    const whole = new Uint8Array(encode(surfaceFrame([5, -6, 7, -8])));
    for (let length = 1; length < whole.length; ++length) expect(parse(whole.slice(0, length).buffer).kind).not.toBe("surface");
    for (let at = 0; at < whole.length; ++at)
      for (const flip of [1, 0x80, 0xff]) {
        const bytes = whole.slice();
        bytes[at]! ^= flip;
        const parsed = parse(bytes.buffer);
        if (parsed.kind === "surface") expect(crc32c(parsed.payload)).toBe(crc32c(whole.subarray(whole.length - 8)));
      }
  });
});

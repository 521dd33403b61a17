import { describe, expect, it } from "vitest";

import { crc32c } from "../client/codec/frame_reader";
import { kMaxBodyCount, kMaxParticleCount } from "../client/codec/frame_types";
import { parse } from "../client/codec/parse";
import { CouplingMode, Side, WaveBoundary } from "../client/gen/spindrift/v1/scene_pb";
import { Layer, RejectReason, RoomEventKind } from "../client/gen/spindrift/v1/wire_pb";
import { bodiesFrame, bodiesPayload, encode, foamFrame, greeting, particleFrame, surfaceFrame } from "./wire";

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
      wave: { resolutionCount: 256, sideM: 16, depthM: 1.5, periodicX: true, periodicZ: true },
      parameters: [{ path: "particles.viscosity_pas", value: 55, min: 0, max: 500, step: 1 }],
    });
  });

  it("takes the box's side as the water's side where there is no wave", () => {
    const parsed = parse(encode(greeting({ scene: { particles: { boxSideM: 2.4 } } })));
    expect(parsed).toMatchObject({ kind: "greeting", greeting: { wave: undefined, sideM: 2.4 } });
  });

  it("reads whether the wave breaks, and how thick the particles lie that it carries", () => {
    const read = (scene: object) => {
      const parsed = parse(encode(greeting({ scene })));
      if (parsed.kind !== "greeting") throw new Error(parsed.kind);
      return parsed.greeting;
    };
    const wave = { resolutionCount: 64, sideM: 16, depthM: 1 };
    const particles = { count: 1024, layersCount: 4, patchScale: 0.5 };
    // 4 layers of 16 x 16 particles over 8 m.
    expect(read({ gravityMps2: 9.81, wave, particles })).toMatchObject({ gravityMps2: 9.81, hasBreakers: false, bandM: 2 });
    expect(read({ wave, particles, coupling: { mode: CouplingMode.TWO_WAY } })).toMatchObject({ hasBreakers: true, bandM: 0 });
    expect(read({ wave, foam: { surface: true } })).toMatchObject({ hasBreakers: true, bandM: 0, gravityMps2: 0 });
    expect(read({ wave: { ...wave, steepeningRatio: 0.4 } }).hasBreakers).toBe(true);
    expect(read({ particles: { boxSideM: 4 }, foam: {} })).toMatchObject({ hasBreakers: false, bandM: 0 });
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
    expect(parsed.header).toEqual({ tick: 7n, stateId: 0n, timeS: 0.25, serverTimeS: 0, level: "full", resolutionCount: 2, countZ: 2, sideM: 16, widthM: 16, quantumM: 0.001 });
    expect(parsed.payload.buffer).toBe(buffer);
    expect([...new Int16Array(parsed.payload.slice().buffer)]).toEqual([0, 1, -2, 32767]);
  });

  it("reads particles with their bounds", () => {
    const parsed = parse(encode(particleFrame(Uint8Array.from({ length: 24 }, (_, i) => i))));
    if (parsed.kind !== "particles") throw new Error(parsed.kind);
    expect(parsed.header).toEqual({ tick: 8n, stateId: 0n, timeS: 0.5, serverTimeS: 0, level: "full", count: 2, minM: [-8, -1.5, -8], maxM: [8, 5, 8], wordMinM: [-8, -1.5, -8], wordMaxM: [8, 5, 8], maxSpeedMps: 9, radiusM: 0.15 });
    expect(parsed.payload.length).toBe(24);
  });

  it("reads every other kind of message", () => {
    expect(parse(encode({ case: "ack", value: { commandId: 3n, appliedTick: 99n, boatId: 7 } }))).toEqual({ kind: "ack", commandId: 3n, appliedTick: 99n, boatId: 7, floaterId: 0, gaugeId: 0 });
    expect(
      parse(encode({ case: "reject", value: { commandId: 4n, reason: RejectReason.OUT_OF_RANGE, field: "splash.radius_m", message: "too wide" } })),
    ).toEqual({ kind: "reject", commandId: 4n, reason: "OUT_OF_RANGE", field: "splash.radius_m", message: "too wide" });
    expect(parse(encode({ case: "parameterChanged", value: { path: "p", value: 2, appliedTick: 5n } }))).toEqual({ kind: "parameterChanged", path: "p", value: 2, appliedTick: 5n });
    expect(parse(encode({ case: "roomState", value: { paused: true, speed: 2, personId: 7, clockPersonIds: [7] } }))).toEqual({ kind: "roomState", paused: true, speed: 2, personId: 7, clockPersonIds: [7] });
    expect(parse(encode({ case: "pong", value: { clientTimeS: 1, serverTimeS: 2 } }))).toEqual({ kind: "pong", clientTimeS: 1, serverTimeS: 2 });
    expect(parse(encode({ case: "refusal", value: { message: "no" } }))).toEqual({ kind: "refusal", message: "no" });
    const parsed = parse(encode({ case: "diagnostics", value: { tick: 6n, stepMs: 4.5, nonfiniteCount: 1n, passes: [{ name: "sph", ms: 3 }] } }));
    expect(parsed).toMatchObject({ kind: "diagnostics", diagnostics: { tick: 6n, stepMs: 4.5, nonfiniteCount: 1n, passes: [{ name: "sph", ms: 3 }] } });
  });

  it("reads gauges at places that can be drawn, and at most as many as there can be", () => {
    const gauges = [{ name: "toe", xM: -2 }, { name: "G1", xM: NaN, gaugeId: 1 }, { name: "G2", zM: 1e300, gaugeId: 2 }, { name: "G3", xM: 4, zM: -1, gaugeId: 3, personId: 9, unread: true }];
    const parsed = parse(encode({ case: "diagnostics", value: { gauges } }));
    if (parsed.kind !== "diagnostics") throw new Error(JSON.stringify(parsed));
    expect(parsed.diagnostics.gauges.map(({ name }) => name)).toEqual(["toe", "G3"]);
    expect(parsed.diagnostics.gauges[1]).toEqual({ name: "G3", xM: 4, zM: -1, gaugeId: 3, personId: 9, unread: true, elevationM: 0, velocityXMps: 0, velocityZMps: 0, highestM: 0, lowestM: 0 });
    const many = parse(encode({ case: "diagnostics", value: { gauges: Array.from({ length: 100 }, (_, n) => ({ name: `G${n}`, gaugeId: n })) } }));
    expect(many.kind === "diagnostics" && many.diagnostics.gauges.length).toBe(64);
    expect(() => structuredClone(parsed)).not.toThrow();
  });

  it("ignores an empty message and a kind it does not know", () => {
    expect(parse(new ArrayBuffer(0)).kind).toBe("unknown");
    expect(parse(Uint8Array.of(0xa2, 0x06, 0x01, 0x00).buffer).kind).toBe("unknown");
  });

  it("refuses frames whose payload does not fit their header", () => {
    expectMalformed(encode(surfaceFrame([0, 0, 0, 0], { payload: new Uint8Array(6) })), /payload of 6 bytes, header says 8/);
    expectMalformed(encode(particleFrame(new Uint8Array(24), {}, { count: 3 })), /payload of 24 bytes, header says 36/);
    expectMalformed(encode(particleFrame(new Uint8Array(0), {}, { count: kMaxParticleCount + 1 })), /at most/);
    expectMalformed(encode(surfaceFrame([0, 0, 0, 0], { codec: { case: "surfaceFixed16", value: { resolutionCount: 5000, sideM: 1, quantumM: 1 } } as never })), /5000 samples/);
  });

  it("refuses a wrong checksum, a delta, a foreign layer and an unknown codec", () => {
    expectMalformed(encode(surfaceFrame([1, 2, 3, 4], { crc32c: 1 })), /crc32c/);
    expectMalformed(encode(surfaceFrame([1, 2, 3, 4], { keyframe: false })), /keyframes/);
    expectMalformed(encode(surfaceFrame([1, 2, 3, 4], { layer: Layer.PARTICLES })), /carries a surface/);
    expectMalformed(encode(particleFrame(new Uint8Array(12), { layer: Layer.SURFACE })), /carries particles/);
    expectMalformed(encode(surfaceFrame([1, 2, 3, 4], { codec: { case: undefined } })), /codec/);
  });

  it("refuses numbers that cannot be drawn", () => {
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

describe("parse of foam, boats and obstacles", () => {
  const boat = { boatId: 3, lengthM: 2.4, beamM: 0.9, heightM: 0.6, draughtM: 0.24 };

  it("reads foam and bodies as views into the message", () => {
    const foam = parse(encode(foamFrame(Uint8Array.of(0, 80, 255, 9))));
    expect(foam).toMatchObject({ kind: "foam", header: { tick: 9n, stateId: 0n, timeS: 0.5, resolutionCount: 2, sideM: 16 } });
    const buffer = encode(bodiesFrame(bodiesPayload([{ boatId: 5 }, { boatId: 6 }])));
    const bodies = parse(buffer);
    if (bodies.kind !== "bodies") throw new Error(JSON.stringify(bodies));
    expect(bodies.header).toEqual({ tick: 9n, stateId: 0n, timeS: 0.5, serverTimeS: 0, level: "full", count: 2 });
    expect(bodies.payload.buffer).toBe(buffer);
  });

  it("reads planes with other numbers along x and z, down to one", () => {
    const wide = parse(encode(foamFrame(new Uint8Array([1, 2, 3]), {}, { resolutionCount: 3, countZ: 1, sideM: 6, widthM: 2 })));
    expect(wide).toMatchObject({ kind: "foam", header: { resolutionCount: 3, countZ: 1, sideM: 6, widthM: 2 } });
    const square = parse(encode(foamFrame(new Uint8Array(4), {}, { resolutionCount: 2, sideM: 16 })));
    expect(square).toMatchObject({ kind: "foam", header: { resolutionCount: 2, countZ: 2, sideM: 16, widthM: 16 } });
  });

  it("accepts frames without particles or boats", () => {
    expect(parse(encode(particleFrame(new Uint8Array(0))))).toMatchObject({ kind: "particles", header: { count: 0 } });
    expect(parse(encode(bodiesFrame(new Uint8Array(0))))).toMatchObject({ kind: "bodies", header: { count: 0 } });
  });

  it("refuses hostile sizes before it touches the payload", () => {
    for (const count of [4097, 0xffffffff])
      for (const counts of [{ resolutionCount: count }, { countZ: count }]) expectMalformed(encode(foamFrame(new Uint8Array(4), {}, counts)), /foam of/);
    expectMalformed(encode(foamFrame(new Uint8Array(4), {}, { resolutionCount: 0 })), /foam of/);
    expectMalformed(encode(foamFrame(new Uint8Array(4), {}, { widthM: -1 })), /foam side/);
    expectMalformed(encode(foamFrame(new Uint8Array(4), {}, { resolutionCount: 2, countZ: 3 })), /payload of 4 bytes, header says 6/);
    for (const sideM of [0, -1, Number.NaN, Number.POSITIVE_INFINITY, 2e6]) expectMalformed(encode(foamFrame(new Uint8Array(4), {}, { sideM })), /foam side/);
    for (const count of [kMaxBodyCount + 1, 0xffffffff]) expectMalformed(encode(bodiesFrame(new Uint8Array(28), {}, count)), /at most/);
    expectMalformed(encode(foamFrame(new Uint8Array(5), {}, { resolutionCount: 2 })), /payload of 5 bytes, header says 4/);
    expectMalformed(encode(bodiesFrame(new Uint8Array(55), {}, 2)), /payload of 55 bytes, header says 56/);
    expectMalformed(encode(bodiesFrame(new Uint8Array(28), {}, 0)), /payload of 28 bytes, header says 0/);
  });

  it("refuses a wrong checksum, layer, time and a delta of the new layers", () => {
    const payload = bodiesPayload([{}]);
    expectMalformed(encode(foamFrame(new Uint8Array(4), { crc32c: 1 })), /crc32c/);
    expectMalformed(encode(bodiesFrame(payload, { crc32c: 1 })), /crc32c/);
    expectMalformed(encode(foamFrame(new Uint8Array(4), { layer: Layer.SURFACE })), /carries foam/);
    expectMalformed(encode(bodiesFrame(payload, { layer: Layer.PARTICLES })), /carries bodies/);
    expectMalformed(encode(foamFrame(new Uint8Array(4), { timeS: Number.NaN })), /time_s/);
    expectMalformed(encode(bodiesFrame(payload, { keyframe: false })), /keyframes/);
  });

  it("survives every truncation and every flipped byte of a bodies frame", () => {
    const whole = new Uint8Array(encode(bodiesFrame(bodiesPayload([{ boatId: 9, xMm: -1200 }]))));
    for (let length = 1; length < whole.length; ++length) expect(parse(whole.slice(0, length).buffer).kind).not.toBe("bodies");
    for (let at = 0; at < whole.length; ++at)
      for (const flip of [1, 0x80, 0xff]) {
        const bytes = whole.slice();
        bytes[at]! ^= flip;
        expect(() => parse(bytes.buffer)).not.toThrow();
      }
  });

  it("reads boats, room events and the volume ledger", () => {
    expect(parse(encode({ case: "boatList", value: { boats: [boat] } }))).toEqual({ kind: "boatList", boats: [boat] });
    for (const bad of [{ lengthM: 0 }, { beamM: Number.NaN }, { heightM: 1e9 }, { draughtM: -1 }])
      expectMalformed(encode({ case: "boatList", value: { boats: [{ ...boat, ...bad }] } }), /boat 3/);
    expectMalformed(encode({ case: "boatList", value: { boats: [boat, boat] } }), /two boats/);
    expectMalformed(encode(greeting({ boatList: { boats: [boat, boat] } })), /two boats/);
    expect(parse(encode({ case: "roomEvent", value: { kind: RoomEventKind.RESET, tick: 8n, message: "again", personId: 7 } }))).toEqual({
      kind: "roomEvent", event: "reset", tick: 8n, message: "again", personId: 7,
    });
    const counted = { boatCount: 2, volumeErrorUnits: -3n, emittedM3: 1.5, absorbedM3: 1.25, breakingRatio: 0.01 };
    expect(parse(encode({ case: "diagnostics", value: counted }))).toMatchObject({ kind: "diagnostics", diagnostics: counted });
  });

  it("reads obstacles and beaches, and leaves out invalid ones", () => {
    const scene = {
      name: "harbor",
      wave: { resolutionCount: 256, sideM: 60, depthM: 3, boundaryMinusX: WaveBoundary.ABSORB, boundaryPlusX: WaveBoundary.REFLECT },
      boats: { capacityCount: 4 },
      obstacles: [
        { shape: { case: "rock", value: { xM: 3, zM: -4, radiusM: 2, heightM: 1 } } },
        { shape: { case: "rock", value: { radiusM: Number.NaN } } },
        { shape: { case: "breakwater", value: { xM: 1, zM: 2, lengthM: 20, widthM: 2, headingDeg: 90, heightM: 1.5 } } },
        { shape: { case: undefined } },
      ],
      beaches: [{ side: Side.MINUS_X, widthM: 12, shoreDepthM: 0 }, { side: Side.MINUS_X, widthM: 3 }, { side: Side.DIRECTION, widthM: 3 }],
    };
    const parsed = parse(encode(greeting({ scene, scenes: ["harbor", "splash"], boatList: { boats: [boat] } })));
    if (parsed.kind !== "greeting") throw new Error(JSON.stringify(parsed));
    expect(structuredClone(parsed.greeting)).toMatchObject({
      sceneName: "harbor", scenes: ["harbor", "splash"], boats: [boat], hasBoats: true, hasParticles: false,
      wave: { periodicX: false, periodicZ: true },
      obstacles: [
        { shape: "rock", xM: 3, zM: -4, radiusM: 2, heightM: 1 },
        { shape: "breakwater", xM: 1, zM: 2, lengthM: 20, widthM: 2, headingRad: Math.PI / 2, heightM: 1.5 },
      ],
      beaches: [{ side: "-x", widthM: 12, shoreDepthM: 0 }],
    });
  });
});

// The golden bytes of the C++ tests, read by this client with the same results.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { describe, expect, it } from "vitest";

import type { Malformed } from "../client/codec/malformed";
import type { PackedFrame } from "../client/codec/frame_types";
import { FrameUnpacker } from "../client/codec/frame_unpacker";
import { parse, type ParsedMessage } from "../client/codec/parse";
import type { BodyPose } from "../client/codec/bodies";
import { unpackBodies } from "../src/scene/frames/bodies";
import { unpackFloaters } from "../src/scene/frames/floaters";
import { elevationAtM } from "../src/scene/frames/height_field";
import { isPacked } from "./wire";

interface GoldenCase {
  file: string;
  verdict: "ok" | "bad_frame" | "bad_message";
  kind?: string;
  [field: string]: unknown;
}

const kFolder = join(import.meta.dirname, "..", "..", "tests", "golden");
const cases = JSON.parse(readFileSync(join(kFolder, "golden.json"), "utf8")) as GoldenCase[];

function read(file: string): ArrayBuffer {
  const bytes = readFileSync(join(kFolder, file));
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength) as ArrayBuffer;
}

/** snake_case of the proto → the names that protoc-gen-es makes. */
function camel(name: string): string {
  return name.replace(/_([a-z0-9])/g, (_, letter: string) => letter.toUpperCase());
}

/** Unpacks packed frames like the connection, after the golden frames that they build on. */
function unpacked(golden: GoldenCase, unpacker = new FrameUnpacker()): Exclude<ParsedMessage, PackedFrame> | Malformed {
  const before = cases.find((c) => c.file !== "" && c.file === golden["follows"]);
  if (before) unpacked(before, unpacker);
  const parsed = parse(read(golden.file));
  if (!isPacked(parsed)) return parsed;
  const plain = unpacker.unpack(parsed);
  return plain.kind === "missingBase" ? { kind: "malformed", reason: "the frame before is missing" } : plain;
}

/** Kinds and layers that the tests below read; the first test fails if golden.json has another one. */
const kKinds = ["frame", "diagnostics", "greeting", "ack", "reject", "boat_list", "room_event", "draining"];
const kLayers = ["LAYER_SURFACE", "LAYER_PARTICLES", "LAYER_FOAM", "LAYER_BODIES", "LAYER_FLOATERS"];

/** A plane's samples and sides; a square names those along x only. */
function extentsOf(golden: GoldenCase): object {
  const [resolutionCount, sideM] = [golden["resolution_count"], golden["side_m"]];
  return { resolutionCount, sideM, countZ: golden["count_z"] ?? resolutionCount, widthM: golden["width_m"] ?? sideM };
}

describe("golden bytes", () => {
  it("have only verdicts, kinds and layers that a test here reads", () => {
    expect(new Set(cases.map((c) => c.verdict))).toEqual(new Set(["ok", "bad_frame", "bad_message"]));
    const good = cases.filter((c) => c.verdict === "ok");
    expect(new Set(good.map((c) => c.kind))).toEqual(new Set(kKinds));
    expect(new Set(good.filter((c) => c.kind === "frame").map((c) => c["layer"]))).toEqual(new Set(kLayers));
  });

  it.each(cases.filter((c) => c.verdict === "bad_frame"))("refuses $file: $why", (golden) => {
    expect(unpacked(golden).kind).toBe("malformed");
  });

  it.each(cases.filter((c) => c.verdict === "bad_message"))("refuses or ignores $file: $why", ({ file }) => {
    expect(["malformed", "unknown"]).toContain(parse(read(file)).kind);
  });

  it.each(cases.filter((c) => c["layer"] === "LAYER_SURFACE"))("decodes the surface of $file exactly", (golden) => {
    const parsed = unpacked(golden);
    if (parsed.kind !== "surface") throw new Error(JSON.stringify(parsed));
    const { header, payload } = parsed;
    expect(header).toEqual({
      tick: BigInt(golden["tick"] as string), stateId: BigInt((golden["state_id"] ?? "0") as string), timeS: golden["time_s"], serverTimeS: 0, level: "full", ...extentsOf(golden), quantumM: golden["quantum_m"],
    });
    const frame = { layer: "surface" as const, ...header, buffer: payload.slice().buffer };
    const n = header.resolutionCount;
    const samples = new Int16Array(frame.buffer);
    (golden["elevation_m"] as number[]).forEach((elevation, at) => {
      const xM = ((at % n) + 0.5) * (header.sideM / n) - header.sideM / 2;
      const zM = (Math.floor(at / n) + 0.5) * (header.widthM / header.countZ) - header.widthM / 2;
      expect(Math.fround(samples[at]! * header.quantumM)).toBe(Math.fround(elevation));
      expect(elevationAtM(frame, xM, zM)).toBeCloseTo(elevation, 7);
    });
  });

  it.each(cases.filter((c) => c["layer"] === "LAYER_PARTICLES"))("decodes the particles of $file as the shader does", (golden) => {
    const parsed = unpacked(golden);
    if (parsed.kind !== "particles") throw new Error(JSON.stringify(parsed));
    const { header, payload } = parsed;
    expect(header).toMatchObject({ tick: BigInt(golden["tick"] as string), count: golden["count"], radiusM: golden["radius_m"] });
    // A camera frames these bounds: particles are inside, and a packed grid reaches less than a cell beyond the water's.
    expect(header.minM.every((min, axis) => min <= header.wordMinM[axis]!)).toBe(true);
    expect(header.maxM.every((max) => max <= 8 + 4 * header.radiusM)).toBe(true);
    // The vertex shader's arithmetic on the six u16 of a particle.
    const words = new Uint16Array(payload.slice().buffer);
    const signedByte = (bits: number): number => ((bits << 24) >> 24) / 127;
    const positions = golden["position_m"] as number[];
    const velocities = golden["velocity_mps"] as number[];
    for (let i = 0; i < header.count; ++i) {
      const [x, z, y, vxy, vzTint, foam] = words.subarray(6 * i, 6 * i + 6) as unknown as [number, number, number, number, number, number];
      [x, y, z].forEach((word, axis) => {
        const min = header.wordMinM[axis]!;
        const max = header.wordMaxM[axis]!;
        expect(Math.abs(min + (word / 65535) * (max - min) - positions[3 * i + axis]!)).toBeLessThan(1e-6 * (max - min));
      });
      [vxy & 255, vxy >> 8, vzTint & 255].forEach((bits, axis) => {
        expect(Math.abs(signedByte(bits) * header.maxSpeedMps - velocities[3 * i + axis]!)).toBeLessThan(1e-6 * header.maxSpeedMps);
      });
      expect(vzTint >> 8).toBe((golden["tint"] as number[])[i]);
      expect(foam & 255).toBe((golden["foam"] as number[])[i]);
    }
  });

  it.each(cases.filter((c) => c["layer"] === "LAYER_FOAM"))("reads the foam of $file to the last byte", (golden) => {
    const parsed = unpacked(golden);
    if (parsed.kind !== "foam") throw new Error(JSON.stringify(parsed));
    expect(parsed.header).toEqual({
      tick: BigInt(golden["tick"] as string), stateId: BigInt((golden["state_id"] ?? "0") as string), timeS: golden["time_s"], serverTimeS: 0, level: "full", ...extentsOf(golden),
    });
    expect([...parsed.payload]).toEqual(golden["foam"]);
  });

  it.each(cases.filter((c) => c["layer"] === "LAYER_BODIES"))("unpacks the boats of $file", (golden) => {
    const parsed = parse(read(golden.file));
    if (parsed.kind !== "bodies") throw new Error(JSON.stringify(parsed));
    const { header, payload } = parsed;
    expect(header).toEqual({ tick: BigInt(golden["tick"] as string), stateId: BigInt((golden["state_id"] ?? "0") as string), timeS: golden["time_s"], serverTimeS: 0, level: "full", count: golden["count"] });
    const { bodies } = unpackBodies({ layer: "bodies", ...header, buffer: payload.slice().buffer });
    const wanted = golden["bodies"] as Record<string, number | number[]>[];
    expect(bodies).toHaveLength(wanted.length);
    wanted.forEach((boat, i) => {
      const { boatId, xM, yM, zM, headingRad, pitchRad, rollRad, speedMps, throttle, rudder } = bodies[i] as BodyPose;
      expect([boatId, xM, yM, zM]).toEqual([boat["boat_id"], ...(boat["position_m"] as number[])]);
      // The file holds nine decimal digits.
      expect(headingRad).toBeCloseTo(boat["heading_rad"] as number, 8);
      expect(pitchRad).toBeCloseTo(boat["pitch_rad"] as number, 8);
      expect(rollRad).toBeCloseTo(boat["roll_rad"] as number, 8);
      expect(speedMps).toBeCloseTo(boat["speed_mps"] as number, 8);
      expect(throttle).toBeCloseTo(boat["throttle_ratio"] as number, 8);
      expect(rudder).toBeCloseTo(boat["rudder_ratio"] as number, 8);
    });
  });

  it.each(cases.filter((c) => c["layer"] === "LAYER_FLOATERS"))("unpacks the objects of $file", (golden) => {
    const parsed = unpacked(golden);
    if (parsed.kind !== "floaters") throw new Error(JSON.stringify(parsed));
    const { header, payload } = parsed;
    expect(header).toEqual({ tick: BigInt(golden["tick"] as string), stateId: 0n, timeS: golden["time_s"], serverTimeS: 0, level: "full", count: golden["count"], quantumM: golden["quantum_m"] ?? 0.001 });
    const { floaters } = unpackFloaters({ layer: "floaters", ...header, buffer: payload.slice().buffer });
    const wanted = golden["floaters"] as Record<string, unknown>[];
    expect(floaters).toHaveLength(wanted.length);
    wanted.forEach((floater, i) => {
      const { floaterId, xM, yM, zM, turn, sizeM, kind, isHeld } = floaters[i]!;
      expect(floaterId).toBe(floater["floater_id"]);
      [xM, yM, zM].forEach((atM, axis) => expect(atM).toBeCloseTo((floater["position_m"] as number[])[axis]!, 6));
      // The file holds the quaternion as it was read; the page makes it a unit one.
      turn.forEach((part, k) => expect(part).toBeCloseTo((floater["rotation"] as number[])[k]!, 3));
      expect([sizeM, `FLOATER_KIND_${kind.toUpperCase()}`, isHeld]).toEqual([floater["size_m"], floater["kind"], floater["is_held"]]);
    });
  });

  it.each(cases.filter((c) => c.kind === "boat_list"))("reads the boats of $file", (golden) => {
    const boats = golden["boats"] as Record<string, number>[];
    expect(parse(read(golden.file))).toEqual({
      kind: "boatList", boats: boats.map((boat) => Object.fromEntries(Object.entries(boat).map(([name, value]) => [camel(name), value]))),
    });
  });

  it.each(cases.filter((c) => c.kind === "draining"))("reads the times and the address of $file", (golden) => {
    expect(parse(read(golden.file))).toEqual({
      kind: "draining",
      draining: { closesInS: golden["closes_in_s"], goTo: golden["go_to"], reconnectAfterMinS: golden["reconnect_after_min_s"], reconnectAfterMaxS: golden["reconnect_after_max_s"] },
    });
  });

  it.each(cases.filter((c) => c.kind === "room_event"))("reads the event of $file", (golden) => {
    expect(parse(read(golden.file))).toEqual({
      kind: "roomEvent", event: (golden["event"] as string).replace("ROOM_EVENT_KIND_", "").toLowerCase(),
      tick: BigInt(golden["tick"] as string), message: golden["message"], personId: golden["person_id"] ?? 0,
    });
  });

  it.each(cases.filter((c) => c.kind === "diagnostics"))("reads $file to the last bit", (golden) => {
    const parsed = parse(read(golden.file));
    if (parsed.kind !== "diagnostics") throw new Error(JSON.stringify(parsed));
    const { file: _, verdict: __, kind: ___, ...fields } = golden;
    const bigints = new Set(["tick", "nonfinite_count", "escaped_count", "recovered_count", "volume_error_units"]);
    const { gauges = [], ...numbers } = fields as { gauges?: Record<string, unknown>[] };
    expect(parsed.diagnostics.gauges).toEqual(gauges.map((gauge) => Object.fromEntries(Object.entries(gauge).map(([name, value]) => [camel(name), value]))));
    for (const [name, value] of Object.entries(numbers))
      expect(parsed.diagnostics[camel(name) as keyof typeof parsed.diagnostics], name).toEqual(bigints.has(name) ? BigInt(value as string) : value);
  });

  it("reads the greeting", () => {
    const golden = cases.find((c) => c.kind === "greeting")! as unknown as {
      file: string; version: { major: number; minor: number }; server: string; device: string; room: string; session_id: string;
      scene: { title: string; wave: { side_m: number; depth_m: number } }; parameters: object[]; room_state: object;
      limits: { frame_rate_max_hz: number };
    };
    expect(parse(read(golden.file))).toMatchObject({
      kind: "greeting",
      greeting: {
        versionMajor: golden.version.major, versionMinor: golden.version.minor, server: golden.server, device: golden.device,
        room: golden.room, sessionId: golden.session_id, title: golden.scene.title, layers: ["surface", "particles", "diagnostics"],
        frameRateMaxHz: golden.limits.frame_rate_max_hz, sideM: golden.scene.wave.side_m,
        wave: { sideM: golden.scene.wave.side_m, depthM: golden.scene.wave.depth_m },
        parameters: golden.parameters, ...golden.room_state,
      },
    });
  });

  it.each(cases.filter((c) => c.kind === "ack"))("reads $file with 64-bit numbers whole", (golden) => {
    expect(parse(read(golden.file))).toEqual({
      kind: "ack", commandId: BigInt(golden["command_id"] as string), appliedTick: BigInt(golden["applied_tick"] as string),
      boatId: golden["boat_id"] ?? 0,
      floaterId: golden["floater_id"] ?? 0,
      gaugeId: golden["gauge_id"] ?? 0,
    });
  });

  it.each(cases.filter((c) => c.kind === "reject"))("reads $file", (golden) => {
    expect(parse(read(golden.file))).toEqual({
      kind: "reject", commandId: BigInt(golden["command_id"] as string), reason: (golden["reason"] as string).replace("REJECT_REASON_", ""),
      field: golden["field"], message: golden["message"],
    });
  });
});

// Builds server messages as bytes, the way a server would send them.
import { create, toBinary, type MessageInitShape } from "@bufbuild/protobuf";

import { crc32c } from "../client/codec/frame_reader";
import type { PackedFrame } from "../client/codec/frame_types";
import { Layer, ServerMessageSchema, type ServerMessage } from "../client/gen/spindrift/v1/wire_pb";

export type ServerBody = Exclude<NonNullable<MessageInitShape<typeof ServerMessageSchema>["message"]>, { case: undefined }>;

export function encode(message: ServerBody): ArrayBuffer {
  const bytes = toBinary(ServerMessageSchema, create(ServerMessageSchema, { message } as MessageInitShape<typeof ServerMessageSchema>));
  return bytes.slice().buffer;
}

export function isPacked(message: { kind: string }): message is PackedFrame {
  return message.kind.startsWith("packed");
}

type FrameInit = Extract<ServerMessage["message"], { case: "frame" }>["value"];

export function surfaceFrame(values: number[], change: Partial<FrameInit> = {}): ServerBody {
  const payload = new Uint8Array(Int16Array.from(values).buffer);
  const resolutionCount = Math.sqrt(values.length);
  return {
    case: "frame",
    value: {
      layer: Layer.SURFACE, tick: 7n, timeS: 0.25, keyframe: true, crc32c: crc32c(payload), payload,
      codec: { case: "surfaceFixed16", value: { resolutionCount, sideM: 16, quantumM: 0.001 } },
      ...change,
    },
  } as ServerBody;
}

export function particleFrame(payload: Uint8Array, change: Partial<FrameInit> = {}, codec: Record<string, number> = {}): ServerBody {
  return {
    case: "frame",
    value: {
      layer: Layer.PARTICLES, tick: 8n, timeS: 0.5, keyframe: true, crc32c: crc32c(payload), payload,
      codec: {
        case: "particlesFixed12",
        value: {
          count: payload.length / 12, minXM: -8, minYM: -1.5, minZM: -8, maxXM: 8, maxYM: 5, maxZM: 8, maxSpeedMps: 9, radiusM: 0.15,
          ...codec,
        },
      },
      ...change,
    },
  } as ServerBody;
}

export function foamFrame(payload: Uint8Array, change: Partial<FrameInit> = {}, codec: Record<string, number> = {}): ServerBody {
  return {
    case: "frame",
    value: {
      layer: Layer.FOAM, tick: 9n, timeS: 0.5, keyframe: true, crc32c: crc32c(payload), payload,
      codec: { case: "foamFixed8", value: { resolutionCount: Math.sqrt(payload.length), sideM: 16, ...codec } },
      ...change,
    },
  } as ServerBody;
}

export interface BodyRecord {
  boatId: number;
  xMm: number;
  yMm: number;
  zMm: number;
  heading: number;
  pitch: number;
  roll: number;
  speedCmps: number;
  throttle: number;
  rudder: number;
}

/** Writes the 28 bytes per boat of the wire. */
export function bodiesPayload(records: Partial<BodyRecord>[]): Uint8Array<ArrayBuffer> {
  const view = new DataView(new ArrayBuffer(28 * records.length));
  records.forEach((record, at) => {
    const { boatId = 1, xMm = 0, yMm = 0, zMm = 0, heading = 0, pitch = 0, roll = 0, speedCmps = 0, throttle = 0, rudder = 0 } = record;
    const from = 28 * at;
    view.setUint32(from, boatId, true);
    [xMm, yMm, zMm].forEach((mm, axis) => view.setInt32(from + 4 + 4 * axis, mm, true));
    [heading, pitch, roll, speedCmps].forEach((value, i) => view.setInt16(from + 16 + 2 * i, value, true));
    view.setInt8(from + 24, throttle);
    view.setInt8(from + 25, rudder);
  });
  return new Uint8Array(view.buffer);
}

export function bodiesFrame(payload: Uint8Array, change: Partial<FrameInit> = {}, count = payload.length / 28): ServerBody {
  return {
    case: "frame",
    value: {
      layer: Layer.BODIES, tick: 9n, timeS: 0.5, keyframe: true, crc32c: crc32c(payload), payload,
      codec: { case: "bodiesFixed28", value: { count } },
      ...change,
    },
  } as ServerBody;
}

export interface FloaterRecord {
  floaterId: number;
  xMm: number;
  yMm: number;
  zMm: number;
  turn: number[];
  sizeCm: number;
  kind: number;
  flags: number;
}

/** Writes the 28 bytes per object of the wire. */
export function floatersPayload(records: Partial<FloaterRecord>[]): Uint8Array<ArrayBuffer> {
  const view = new DataView(new ArrayBuffer(28 * records.length));
  records.forEach(({ floaterId = 1, xMm = 0, yMm = 0, zMm = 0, turn = [0, 0, 0, 32767], sizeCm = 60, kind = 1, flags = 0 }, at) => {
    const from = 28 * at;
    view.setUint32(from, floaterId, true);
    [xMm, yMm, zMm].forEach((mm, axis) => view.setInt32(from + 4 + 4 * axis, mm, true));
    turn.forEach((value, i) => view.setInt16(from + 16 + 2 * i, value, true));
    view.setUint16(from + 24, sizeCm, true);
    view.setUint8(from + 26, kind);
    view.setUint8(from + 27, flags);
  });
  return new Uint8Array(view.buffer);
}

export function floatersFrame(payload: Uint8Array, change: Partial<FrameInit> = {}, count = payload.length / 28): ServerBody {
  return {
    case: "frame",
    value: {
      layer: Layer.FLOATERS, tick: 9n, timeS: 0.5, keyframe: true, crc32c: crc32c(payload), payload,
      codec: { case: "floatersFixed28", value: { count } },
      ...change,
    },
  } as ServerBody;
}

export function greeting(change: Record<string, unknown> = {}): ServerBody {
  return {
    case: "greeting",
    value: {
      version: { major: 1, minor: 0 },
      server: "spindrift 0.1.0", device: "a device", room: "pool", sessionId: 5n,
      layers: [Layer.SURFACE, Layer.PARTICLES, Layer.DIAGNOSTICS],
      limits: { messageMaxBytes: 16384, commandsPerS: 100, frameRateMaxHz: 30 },
      scene: { name: "pool", title: "Splash pool", wave: { resolutionCount: 256, sideM: 16, depthM: 1.5 }, particles: { count: 8192 } },
      parameters: [
        { path: "particles.viscosity_pas", label: "Viscosity", unit: "Pa s", min: 0, max: 500, step: 1, default: 40, value: 55, help: "Calms." },
      ],
      roomState: { paused: true, speed: 0.5 },
      ...change,
    },
  } as ServerBody;
}

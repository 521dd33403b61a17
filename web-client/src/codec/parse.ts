// Bytes of one WebSocket message → one member of a discriminated union. Pure: no state, no exception; what cannot be
// trusted comes back as "malformed" with the reason. Payloads are views into the message, not copies.
import { fromBinary } from "@bufbuild/protobuf";

import { Layer, RejectReason, ServerMessageSchema, type LayerFrame } from "../gen/spindrift/v1/wire_pb";
import { crc32c } from "./crc32c";
import { readGreeting, type GreetingInfo } from "./greeting";

/** Largest grid side and particle count this client takes; both far above what a server sends. */
export const kMaxResolutionCount = 4096;
export const kMaxParticleCount = 4 * 1024 * 1024;
export const kParticleBytes = 12;

// 64-bit integers stay bigint: beyond 2^53 a number would round them.

/** What every frame carries: tick, and simulation time in seconds. */
export interface FrameHeader {
  tick: bigint;
  timeS: number;
}

/** Elevation of sample (i, k) = int16 value * quantumM; it lies at x = (i + 1/2) sideM / n - sideM / 2, z with k. */
export interface SurfaceHeader extends FrameHeader {
  resolutionCount: number;
  sideM: number;
  quantumM: number;
}

/** Position = min + u16 / 65535 (max - min) a axis; velocity = i8 / 127 maxSpeedMps. Metres, axes x, y, z. */
export interface ParticleHeader extends FrameHeader {
  count: number;
  minM: [number, number, number];
  maxM: [number, number, number];
  maxSpeedMps: number;
  radiusM: number;
}

export interface DiagnosticsInfo {
  tick: bigint;
  timeS: number;
  stepMs: number;
  realTimeFactor: number;
  substepsCount: number;
  particleCount: number;
  maxParticleSpeedMps: number;
  maxElevationM: number;
  meanDensityRatio: number;
  maxDensityRatio: number;
  kineticEnergyJ: number;
  potentialEnergyJ: number;
  waveEnergyJ: number;
  nonfiniteCount: bigint;
  escapedCount: bigint;
  recoveredCount: bigint;
  passes: { name: string; ms: number }[];
}

export type ParsedMessage =
  | { kind: "greeting"; greeting: GreetingInfo }
  | { kind: "surface"; header: SurfaceHeader; payload: Uint8Array }
  | { kind: "particles"; header: ParticleHeader; payload: Uint8Array }
  | { kind: "diagnostics"; diagnostics: DiagnosticsInfo }
  | { kind: "ack"; commandId: bigint; appliedTick: bigint }
  | { kind: "reject"; commandId: bigint; reason: string; field: string; message: string }
  | { kind: "parameterChanged"; path: string; value: number; appliedTick: bigint }
  | { kind: "roomState"; paused: boolean; speed: number }
  | { kind: "pong"; clientTimeS: number; serverTimeS: number }
  | { kind: "refusal"; message: string }
  | { kind: "unknown" }
  | { kind: "malformed"; reason: string };

function malformed(reason: string): ParsedMessage {
  return { kind: "malformed", reason };
}

function isPositive(value: number): boolean {
  return Number.isFinite(value) && value > 0;
}

/** Why the frame's common part cannot be trusted, or undefined. */
function frameFault(frame: LayerFrame): string | undefined {
  if (!Number.isFinite(frame.timeS)) return `time_s ${frame.timeS} is not finite`;
  if (!frame.keyframe) return "a frame on top of another one, but this codec has only keyframes";
  const crc = crc32c(frame.payload);
  if (crc !== frame.crc32c) return `crc32c 0x${crc.toString(16)}, frame says 0x${frame.crc32c.toString(16)}`;
  return undefined;
}

function parseFrame(frame: LayerFrame): ParsedMessage {
  const { payload } = frame;
  const { tick, timeS } = frame;
  if (frame.codec.case === "surfaceFixed16") {
    const { resolutionCount, sideM, quantumM } = frame.codec.value;
    if (frame.layer !== Layer.SURFACE) return malformed(`layer ${frame.layer} carries a surface`);
    if (resolutionCount < 2 || resolutionCount > kMaxResolutionCount)
      return malformed(`surface of ${resolutionCount} samples a side, allowed are 2 to ${kMaxResolutionCount}`);
    if (!isPositive(sideM) || !isPositive(quantumM))
      return malformed(`surface side ${sideM} m and quantum ${quantumM} m have to be above 0`);
    const wantedBytes = resolutionCount * resolutionCount * 2;
    if (payload.length !== wantedBytes)
      return malformed(`surface payload of ${payload.length} bytes, header says ${wantedBytes}`);
    const fault = frameFault(frame);
    if (fault) return malformed(fault);
    return { kind: "surface", header: { tick, timeS, resolutionCount, sideM, quantumM }, payload };
  }
  if (frame.codec.case === "particlesFixed12") {
    const codec = frame.codec.value;
    if (frame.layer !== Layer.PARTICLES) return malformed(`layer ${frame.layer} carries particles`);
    if (codec.count > kMaxParticleCount)
      return malformed(`${codec.count} particles, at most ${kMaxParticleCount} are taken`);
    const minM: [number, number, number] = [codec.minXM, codec.minYM, codec.minZM];
    const maxM: [number, number, number] = [codec.maxXM, codec.maxYM, codec.maxZM];
    for (let axis = 0; axis < 3; ++axis) {
      const low = minM[axis]!;
      const high = maxM[axis]!;
      if (!Number.isFinite(low) || !Number.isFinite(high) || low > high)
        return malformed(`particle bounds ${low} m to ${high} m on axis ${"xyz"[axis]}`);
    }
    if (!Number.isFinite(codec.maxSpeedMps) || codec.maxSpeedMps < 0)
      return malformed(`particle speed bound ${codec.maxSpeedMps} m/s`);
    if (!isPositive(codec.radiusM)) return malformed(`particle radius ${codec.radiusM} m has to be above 0`);
    const wantedBytes = codec.count * kParticleBytes;
    if (payload.length !== wantedBytes)
      return malformed(`particle payload of ${payload.length} bytes, header says ${wantedBytes}`);
    const fault = frameFault(frame);
    if (fault) return malformed(fault);
    const { count, maxSpeedMps, radiusM } = codec;
    return { kind: "particles", header: { tick, timeS, count, minM, maxM, maxSpeedMps, radiusM }, payload };
  }
  return malformed(`frame of layer ${frame.layer} in a codec this client does not know`);
}

/** Reads one binary message. Never throws. */
export function parse(buffer: ArrayBuffer): ParsedMessage {
  try {
    const { message } = fromBinary(ServerMessageSchema, new Uint8Array(buffer));
    switch (message.case) {
      case "greeting":
        return readGreeting(message.value);
      case "frame":
        return parseFrame(message.value);
      case "diagnostics": {
        const { $typeName: _, $unknown: __, passes, ...numbers } = message.value;
        return { kind: "diagnostics", diagnostics: { ...numbers, passes: passes.map(({ name, ms }) => ({ name, ms })) } };
      }
      case "ack":
        return { kind: "ack", commandId: message.value.commandId, appliedTick: message.value.appliedTick };
      case "reject": {
        const { commandId, reason, field, message: text } = message.value;
        return { kind: "reject", commandId, reason: RejectReason[reason] ?? `${reason}`, field, message: text };
      }
      case "parameterChanged": {
        const { path, value, appliedTick } = message.value;
        if (!Number.isFinite(value)) return malformed(`parameter ${path} is ${value}`);
        return { kind: "parameterChanged", path, value, appliedTick };
      }
      case "roomState":
        return { kind: "roomState", paused: message.value.paused, speed: message.value.speed };
      case "pong":
        return { kind: "pong", clientTimeS: message.value.clientTimeS, serverTimeS: message.value.serverTimeS };
      case "refusal":
        return { kind: "refusal", message: message.value.message };
      case undefined:
        // A kind that a newer server knows, or an empty message: the wire says to ignore it.
        return { kind: "unknown" };
    }
  } catch (error) {
    return malformed(error instanceof Error ? error.message : String(error));
  }
}

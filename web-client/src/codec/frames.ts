// A LayerFrame → its header as plain data and its payload as a view, or the reason why it cannot be trusted. Pure.
import { Layer, type LayerFrame } from "../gen/spindrift/v1/wire_pb";
import { crc32c } from "./crc32c";
import { kWeightCount } from "./frame_reader";
import { levelName, type LevelName } from "./level";
import { malformed, type Malformed } from "./malformed";
import { unpackParticles } from "./packed_particles";
import type { PackedFoam, PackedSurface } from "./packed_planes";

/** Largest grid side and counts this client takes; all far above what a server sends. */
export const kMaxResolutionCount = 4096;
export const kMaxParticleCount = 4 * 1024 * 1024;
export const kMaxBodyCount = 1024;
export const kParticleBytes = 12;
export const kBodyBytes = 28;
/** Bits of a packed particle's place within its cell; places along an axis; cells. */
const kMaxOffsetBits = 8;
const kMaxPlaceCount = 65536;
const kMaxCellCount = 2 ** 24;
/** No size, place or speed on the wire is beyond this, in metres (a second). */
const kLargest = 1e6;

// 64-bit integers stay bigint: beyond 2^53 a number would round them.

/** What every frame carries: tick, simulation time, when that was on the server's clock, and how much of the layer it is. */
export interface FrameHeader {
  tick: bigint;
  /** Number of the room's state that the frame shows: ticks repeat while the room is paused. 0: an older server. */
  stateId: bigint;
  timeS: number;
  serverTimeS: number;
  level: LevelName;
}

/** Elevation of sample (i, k) = int16 value * quantumM; it lies at x = (i + 1/2) sideM / n - sideM / 2, z with k. */
export interface SurfaceHeader extends FrameHeader {
  resolutionCount: number;
  sideM: number;
  quantumM: number;
}

/** Position = wordMin + u16 / 65535 (wordMax - wordMin) a axis; velocity = i8 / 127 maxSpeedMps. Metres, axes x, y, z. */
export interface ParticleHeader extends FrameHeader {
  count: number;
  /** Where particles can be. */
  minM: [number, number, number];
  maxM: [number, number, number];
  /** The places of the words 0 and 65535. */
  wordMinM: [number, number, number];
  wordMaxM: [number, number, number];
  maxSpeedMps: number;
  radiusM: number;
}

/** A byte a sample, 0 none to 255 white; samples lie as those of the surface. */
export interface FoamHeader extends FrameHeader {
  resolutionCount: number;
  sideM: number;
}

export interface BodiesHeader extends FrameHeader {
  count: number;
}

export type ParsedFrame =
  | { kind: "surface"; header: SurfaceHeader; payload: Uint8Array }
  | { kind: "particles"; header: ParticleHeader; payload: Uint8Array }
  | { kind: "foam"; header: FoamHeader; payload: Uint8Array }
  | { kind: "bodies"; header: BodiesHeader; payload: Uint8Array };

function isSize(value: number): boolean {
  return value > 0 && value <= kLargest;
}

/** Why a plain frame cannot be trusted, or undefined. */
function plainFault(frame: LayerFrame, layer: Layer, what: string, wantedBytes: number): string | undefined {
  const { payload } = frame;
  if (payload.length !== wantedBytes) return `${what}: payload of ${payload.length} bytes, header says ${wantedBytes}`;
  if (!frame.keyframe) return "a frame on top of another one, but this codec has only keyframes";
  return frameFault(frame, layer, what);
}

/** Why layer, time or payload of a frame cannot be trusted, or undefined. The checksum comes last: it costs most. */
function frameFault(frame: LayerFrame, layer: Layer, what: string): string | undefined {
  const { payload } = frame;
  if (frame.layer !== layer) return `layer ${frame.layer} carries ${what}`;
  if (!Number.isFinite(frame.timeS)) return `time_s ${frame.timeS} is not finite`;
  if (!Number.isFinite(frame.serverTimeS)) return `server_time_s ${frame.serverTimeS} is not finite`;
  const crc = crc32c(payload);
  return crc === frame.crc32c ? undefined : `crc32c 0x${crc.toString(16)}, frame says 0x${frame.crc32c.toString(16)}`;
}

function gridFault(what: string, resolutionCount: number, sideM: number): string | undefined {
  if (resolutionCount < 2 || resolutionCount > kMaxResolutionCount)
    return `${what} of ${resolutionCount} samples a side, allowed are 2 to ${kMaxResolutionCount}`;
  return isSize(sideM) ? undefined : `${what} side ${sideM} m has to be above 0`;
}

function weightsFault(frame: LayerFrame, weights: number[], earlierWeights: number[]): string | undefined {
  if (weights.length === kWeightCount && (!frame.keyframe || earlierWeights.length === kWeightCount)) return undefined;
  return `a plane of ${weights.length} and ${earlierWeights.length} weights, there have to be ${kWeightCount}`;
}

function baseTickOf(frame: LayerFrame): bigint | undefined {
  return frame.keyframe ? undefined : frame.baseTick;
}

export function parseFrame(frame: LayerFrame): ParsedFrame | PackedSurface | PackedFoam | Malformed {
  const { tick, stateId, timeS, serverTimeS, payload, codec } = frame;
  const of: FrameHeader = { tick, stateId, timeS, serverTimeS, level: levelName(frame.level) };
  switch (codec.case) {
    case "surfaceFixed16": {
      const { resolutionCount, sideM, quantumM } = codec.value;
      const fault =
        gridFault("surface", resolutionCount, sideM) ??
        (isSize(quantumM) ? undefined : `surface quantum ${quantumM} m has to be above 0`) ??
        plainFault(frame, Layer.SURFACE, "a surface", 2 * resolutionCount * resolutionCount);
      return fault ? malformed(fault) : { kind: "surface", header: { ...of, resolutionCount, sideM, quantumM }, payload };
    }
    case "surfacePredicted": {
      const { resolutionCount, sideM, quantumM, weights, earlierWeights } = codec.value;
      const fault =
        gridFault("surface", resolutionCount, sideM) ??
        (isSize(quantumM) ? undefined : `surface quantum ${quantumM} m has to be above 0`) ??
        weightsFault(frame, weights, earlierWeights) ??
        frameFault(frame, Layer.SURFACE, "a surface");
      if (fault) return malformed(fault);
      const header = { ...of, resolutionCount, sideM, quantumM };
      return { kind: "packedSurface", header, resolutionCount, baseTick: baseTickOf(frame), weights, earlierWeights, payload };
    }
    case "foamPredicted": {
      const { resolutionCount, sideM, weights, earlierWeights } = codec.value;
      const fault =
        gridFault("foam", resolutionCount, sideM) ?? weightsFault(frame, weights, earlierWeights) ?? frameFault(frame, Layer.FOAM, "foam");
      if (fault) return malformed(fault);
      const header = { ...of, resolutionCount, sideM };
      return { kind: "packedFoam", header, resolutionCount, baseTick: baseTickOf(frame), weights, earlierWeights, payload };
    }
    case "foamFixed8": {
      const { resolutionCount, sideM } = codec.value;
      const fault = gridFault("foam", resolutionCount, sideM) ?? plainFault(frame, Layer.FOAM, "foam", resolutionCount * resolutionCount);
      return fault ? malformed(fault) : { kind: "foam", header: { ...of, resolutionCount, sideM }, payload };
    }
    case "bodiesFixed28": {
      const { count } = codec.value;
      if (count > kMaxBodyCount) return malformed(`${count} bodies, at most ${kMaxBodyCount} are taken`);
      const fault = plainFault(frame, Layer.BODIES, "bodies", count * kBodyBytes);
      return fault ? malformed(fault) : { kind: "bodies", header: { ...of, count }, payload };
    }
    case "particlesFixed12": {
      const { count, minXM, minYM, minZM, maxXM, maxYM, maxZM, maxSpeedMps, radiusM } = codec.value;
      if (count > kMaxParticleCount) return malformed(`${count} particles, at most ${kMaxParticleCount} are taken`);
      const minM: ParticleHeader["minM"] = [minXM, minYM, minZM];
      const maxM: ParticleHeader["maxM"] = [maxXM, maxYM, maxZM];
      for (let axis = 0; axis < 3; ++axis) {
        const low = minM[axis]!;
        const high = maxM[axis]!;
        if (!(low >= -kLargest && high <= kLargest && low <= high))
          return malformed(`particle bounds ${low} m to ${high} m on axis ${"xyz"[axis]}`);
      }
      if (!(maxSpeedMps >= 0 && maxSpeedMps <= kLargest)) return malformed(`particle speed bound ${maxSpeedMps} m/s`);
      if (!isSize(radiusM)) return malformed(`particle radius ${radiusM} m has to be above 0`);
      const fault = plainFault(frame, Layer.PARTICLES, "particles", count * kParticleBytes);
      return fault ? malformed(fault) : { kind: "particles", header: { ...of, count, minM, maxM, wordMinM: minM, wordMaxM: maxM, maxSpeedMps, radiusM }, payload };
    }
    case "particlesByCell": {
      const { count, minXM, minYM, minZM, cellsXCount, cellsYCount, cellsZCount, cellM, offsetBits, velocityQuantumMps, radiusM } = codec.value;
      const cellsCount: [number, number, number] = [cellsXCount, cellsYCount, cellsZCount];
      const minM: ParticleHeader["minM"] = [minXM, minYM, minZM];
      if (count > kMaxParticleCount) return malformed(`${count} particles, at most ${kMaxParticleCount} are taken`);
      if (offsetBits < 1 || offsetBits > kMaxOffsetBits) return malformed(`particles with ${offsetBits} bits of offset`);
      if (cellsCount.some((cells) => cells < 1 || cells > kMaxPlaceCount >> offsetBits) || cellsXCount * cellsYCount * cellsZCount > kMaxCellCount)
        return malformed(`particles in ${cellsCount.join(" x ")} cells`);
      if (minM.some((min) => !(Math.abs(min) <= kLargest)) || !isSize(cellM)) return malformed(`particles from ${minM.join(", ")} m on in cells of ${cellM} m`);
      if (!(velocityQuantumMps >= 0 && velocityQuantumMps <= kLargest)) return malformed(`particle velocity quantum ${velocityQuantumMps} m/s`);
      if (!isSize(radiusM)) return malformed(`particle radius ${radiusM} m has to be above 0`);
      if (!frame.keyframe) return malformed("a frame on top of another one, but this codec has only keyframes");
      const fault = frameFault(frame, Layer.PARTICLES, "particles");
      if (fault) return malformed(fault);
      return unpackParticles({ ...of, count, minM, cellsCount, cellM, offsetBits, velocityQuantumMps, radiusM, payload });
    }
    case undefined:
      return malformed(`frame of layer ${frame.layer} in a codec this client does not know`);
  }
}

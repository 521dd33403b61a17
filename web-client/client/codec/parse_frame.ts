// A LayerFrame → its header as plain data and its payload as a view, or the reason why it cannot be trusted. Pure.
import { Layer, type LayerFrame } from "../gen/spindrift/v1/wire_pb";
import { crc32c, kWeightCount } from "./frame_reader";
import {
  kBodyBytes,
  kFloaterBytes,
  kMaxBodyCount,
  kMaxFloaterCount,
  kMaxParticleCount,
  kMaxResolutionCount,
  kParticleBytes,
  type FrameHeader,
  type PackedFrame,
  type PlaneExtents,
  type PlainFrame,
} from "./frame_types";
import { levelName } from "./layers";
import { malformed, type Malformed } from "./malformed";

const kMaxOffsetBits = 8;
/** Positions along one axis of the packed particles' grid, and cells in the whole of it. */
const kMaxPositionCount = 65536;
const kMaxCellCount = 2 ** 24;
/** Largest size, position or speed on the wire [m, m/s]. */
const kLargest = 1e6;
/** Of packed objects in the water. */
const kMinFloaterQuantumM = 1e-6;
const kMaxFloaterQuantumM = 0.05;
const kMinRotationBits = 6;
const kMaxRotationBits = 13;
const kMaxMotionWeight = 512;
/** Of plain ones. */
const kMillimetreM = 0.001;

type Codec = Exclude<LayerFrame["codec"], { case: undefined }>;
type CodecOf<C extends Codec["case"]> = Extract<Codec, { case: C }>["value"];
/** A reason why a frame cannot be trusted, or undefined. */
type Fault = string | undefined;

export function parseFrame(frame: LayerFrame): PlainFrame | PackedFrame | Malformed {
  const { tick, stateId, timeS, serverTimeS, codec } = frame;
  const header: FrameHeader = { tick, stateId, timeS, serverTimeS, level: levelName(frame.level) };
  switch (codec.case) {
    case "surfaceFixed16":
      return parseSurface(frame, header, codec.value);
    case "surfacePredicted":
      return parsePackedSurface(frame, header, codec.value);
    case "foamFixed8":
      return parseFoam(frame, header, codec.value);
    case "foamPredicted":
      return parsePackedFoam(frame, header, codec.value);
    case "bodiesFixed28":
      return parseBodies(frame, header, codec.value);
    case "floatersFixed28":
      return parseFloaters(frame, header, codec.value);
    case "floatersPredicted":
      return parsePackedFloaters(frame, header, codec.value);
    case "particlesFixed12":
      return parseParticles(frame, header, codec.value);
    case "particlesByCell":
      return parsePackedParticles(frame, header, codec.value);
    case undefined:
      return malformed(`frame of layer ${frame.layer} in a codec this client does not know`);
  }
}

function parseSurface(frame: LayerFrame, header: FrameHeader, codec: CodecOf<"surfaceFixed16">): PlainFrame | Malformed {
  const { quantumM } = codec;
  const plane = extentsOf(codec);
  const fault =
    gridFault("surface", plane) ??
    quantumFault(quantumM) ??
    plainFault(frame, Layer.SURFACE, "a surface", 2 * plane.resolutionCount * plane.countZ);
  return fault ? malformed(fault) : { kind: "surface", header: { ...header, ...plane, quantumM }, payload: frame.payload };
}

function parsePackedSurface(frame: LayerFrame, header: FrameHeader, codec: CodecOf<"surfacePredicted">): PackedFrame | Malformed {
  const { quantumM, weights, earlierWeights } = codec;
  const plane = extentsOf(codec);
  const fault =
    gridFault("surface", plane) ??
    quantumFault(quantumM) ??
    weightsFault(frame, weights, earlierWeights) ??
    frameFault(frame, Layer.SURFACE, "a surface");
  if (fault) return malformed(fault);
  const plain = { ...header, ...plane, quantumM };
  return { kind: "packedSurface", header: plain, baseTick: baseTickOf(frame), weights, earlierWeights, payload: frame.payload };
}

function parseFoam(frame: LayerFrame, header: FrameHeader, codec: CodecOf<"foamFixed8">): PlainFrame | Malformed {
  const plane = extentsOf(codec);
  const fault = gridFault("foam", plane) ?? plainFault(frame, Layer.FOAM, "foam", plane.resolutionCount * plane.countZ);
  return fault ? malformed(fault) : { kind: "foam", header: { ...header, ...plane }, payload: frame.payload };
}

function parsePackedFoam(frame: LayerFrame, header: FrameHeader, codec: CodecOf<"foamPredicted">): PackedFrame | Malformed {
  const { weights, earlierWeights } = codec;
  const plane = extentsOf(codec);
  const fault =
    gridFault("foam", plane) ?? weightsFault(frame, weights, earlierWeights) ?? frameFault(frame, Layer.FOAM, "foam");
  if (fault) return malformed(fault);
  const plain = { ...header, ...plane };
  return { kind: "packedFoam", header: plain, baseTick: baseTickOf(frame), weights, earlierWeights, payload: frame.payload };
}

function parseBodies(frame: LayerFrame, header: FrameHeader, { count }: CodecOf<"bodiesFixed28">): PlainFrame | Malformed {
  if (count > kMaxBodyCount) return malformed(`${count} bodies, at most ${kMaxBodyCount} are taken`);
  const fault = plainFault(frame, Layer.BODIES, "bodies", count * kBodyBytes);
  return fault ? malformed(fault) : { kind: "bodies", header: { ...header, count }, payload: frame.payload };
}

function parseFloaters(frame: LayerFrame, header: FrameHeader, { count }: CodecOf<"floatersFixed28">): PlainFrame | Malformed {
  const fault = floaterCountFault(count) ?? plainFault(frame, Layer.FLOATERS, "floaters", count * kFloaterBytes);
  return fault ? malformed(fault) : { kind: "floaters", header: { ...header, count, quantumM: kMillimetreM }, payload: frame.payload };
}

function parsePackedFloaters(frame: LayerFrame, header: FrameHeader, codec: CodecOf<"floatersPredicted">): PackedFrame | Malformed {
  const { count, quantumM, rotationBits, motionWeight } = codec;
  const fault =
    floaterCountFault(count) ??
    (quantumM >= kMinFloaterQuantumM && quantumM <= kMaxFloaterQuantumM ? undefined : `floaters in quanta of ${quantumM} m`) ??
    (rotationBits >= kMinRotationBits && rotationBits <= kMaxRotationBits ? undefined : `floaters with ${rotationBits} bits of rotation`) ??
    (motionWeight <= kMaxMotionWeight ? undefined : `floaters with a motion weight of ${motionWeight}`) ??
    frameFault(frame, Layer.FLOATERS, "floaters");
  if (fault) return malformed(fault);
  return { kind: "packedFloaters", header: { ...header, count, quantumM }, baseTick: baseTickOf(frame), rotationBits, motionWeight, payload: frame.payload };
}

function parseParticles(frame: LayerFrame, header: FrameHeader, codec: CodecOf<"particlesFixed12">): PlainFrame | Malformed {
  const { count, minXM, minYM, minZM, maxXM, maxYM, maxZM, maxSpeedMps, radiusM } = codec;
  const minM: [number, number, number] = [minXM, minYM, minZM];
  const maxM: [number, number, number] = [maxXM, maxYM, maxZM];
  const fault =
    countFault(count) ??
    boundsFault(minM, maxM) ??
    (isSpeed(maxSpeedMps) ? undefined : `particle speed bound ${maxSpeedMps} m/s`) ??
    radiusFault(radiusM) ??
    plainFault(frame, Layer.PARTICLES, "particles", count * kParticleBytes);
  if (fault) return malformed(fault);
  return { kind: "particles", header: { ...header, count, minM, maxM, wordMinM: minM, wordMaxM: maxM, maxSpeedMps, radiusM }, payload: frame.payload };
}

function parsePackedParticles(frame: LayerFrame, header: FrameHeader, codec: CodecOf<"particlesByCell">): PackedFrame | Malformed {
  const { count, minXM, minYM, minZM, cellsXCount, cellsYCount, cellsZCount, cellM, offsetBits, velocityQuantumMps, radiusM } = codec;
  const minM: [number, number, number] = [minXM, minYM, minZM];
  const cellsCount: [number, number, number] = [cellsXCount, cellsYCount, cellsZCount];
  const fault =
    countFault(count) ??
    cellsFault(cellsCount, offsetBits) ??
    (minM.every((min) => Math.abs(min) <= kLargest) && isSize(cellM) ? undefined : `particles from ${minM.join(", ")} m on in cells of ${cellM} m`) ??
    (isSpeed(velocityQuantumMps) ? undefined : `particle velocity quantum ${velocityQuantumMps} m/s`) ??
    radiusFault(radiusM) ??
    keyframeFault(frame) ??
    frameFault(frame, Layer.PARTICLES, "particles");
  if (fault) return malformed(fault);
  return { kind: "packedParticles", header, count, minM, cellsCount, cellM, offsetBits, velocityQuantumMps, radiusM, payload: frame.payload };
}

function baseTickOf(frame: LayerFrame): bigint | undefined {
  return frame.keyframe ? undefined : frame.baseTick;
}

function isSize(value: number): boolean {
  return value > 0 && value <= kLargest;
}

function isSpeed(value: number): boolean {
  return value >= 0 && value <= kLargest;
}

/** Layer, times and checksum. The checksum comes last: it costs most. */
function frameFault(frame: LayerFrame, layer: Layer, what: string): Fault {
  if (frame.layer !== layer) return `layer ${frame.layer} carries ${what}`;
  if (!Number.isFinite(frame.timeS)) return `time_s ${frame.timeS} is not finite`;
  if (!Number.isFinite(frame.serverTimeS)) return `server_time_s ${frame.serverTimeS} is not finite`;
  const crc = crc32c(frame.payload);
  return crc === frame.crc32c ? undefined : `crc32c 0x${crc.toString(16)}, frame says 0x${frame.crc32c.toString(16)}`;
}

function plainFault(frame: LayerFrame, layer: Layer, what: string, wantedBytes: number): Fault {
  const { length } = frame.payload;
  if (length !== wantedBytes) return `${what}: payload of ${length} bytes, header says ${wantedBytes}`;
  return keyframeFault(frame) ?? frameFault(frame, layer, what);
}

function keyframeFault(frame: LayerFrame): Fault {
  return frame.keyframe ? undefined : "a delta, but this codec has only keyframes";
}

/** What the header of a plane leaves out along z is as along x. */
function extentsOf({ resolutionCount, sideM, countZ, widthM }: PlaneExtents): PlaneExtents {
  return { resolutionCount, sideM, countZ: countZ || resolutionCount, widthM: widthM || sideM };
}

function gridFault(what: string, { resolutionCount, sideM, countZ, widthM }: PlaneExtents): Fault {
  for (const count of [resolutionCount, countZ])
    if (count < 1 || count > kMaxResolutionCount) return `${what} of ${count} samples along an axis, allowed are 1 to ${kMaxResolutionCount}`;
  const bad = [sideM, widthM].find((sizeM) => !isSize(sizeM));
  return bad === undefined ? undefined : `${what} side ${bad} m has to be above 0`;
}

function quantumFault(quantumM: number): Fault {
  return isSize(quantumM) ? undefined : `surface quantum ${quantumM} m has to be above 0`;
}

function weightsFault(frame: LayerFrame, weights: number[], earlierWeights: number[]): Fault {
  if (weights.length === kWeightCount && (!frame.keyframe || earlierWeights.length === kWeightCount)) return undefined;
  return `a plane of ${weights.length} and ${earlierWeights.length} weights, there have to be ${kWeightCount}`;
}

function countFault(count: number): Fault {
  return count > kMaxParticleCount ? `${count} particles, at most ${kMaxParticleCount} are taken` : undefined;
}

function floaterCountFault(count: number): Fault {
  return count > kMaxFloaterCount ? `${count} floaters, at most ${kMaxFloaterCount} are taken` : undefined;
}

function radiusFault(radiusM: number): Fault {
  return isSize(radiusM) ? undefined : `particle radius ${radiusM} m has to be above 0`;
}

function boundsFault(minM: readonly number[], maxM: readonly number[]): Fault {
  const axis = minM.findIndex((low, at) => !(low >= -kLargest && maxM[at]! <= kLargest && low <= maxM[at]!));
  return axis < 0 ? undefined : `particle bounds ${minM[axis]} m to ${maxM[axis]} m on axis ${"xyz"[axis]}`;
}

function cellsFault(cellsCount: readonly [number, number, number], offsetBits: number): Fault {
  if (offsetBits < 1 || offsetBits > kMaxOffsetBits) return `particles with ${offsetBits} bits of offset`;
  const [x, y, z] = cellsCount;
  const isTooLong = cellsCount.some((cells) => cells < 1 || cells > kMaxPositionCount >> offsetBits);
  return isTooLong || x * y * z > kMaxCellCount ? `particles in ${cellsCount.join(" x ")} cells` : undefined;
}

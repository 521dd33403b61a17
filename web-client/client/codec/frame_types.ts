// Frames as plain data: headers, and payloads as views into the message. A plain frame holds the samples or records themselves;
// a packed frame has to be unpacked first.
import type { FrameLayer, LevelName } from "./layers";

/** Limits of this client; all far above what a server sends. */
export const kMaxResolutionCount = 4096;
export const kMaxParticleCount = 4 * 1024 * 1024;
export const kMaxBodyCount = 1024;
export const kMaxFloaterCount = 1024;
/** Size of one record in a plain payload. */
export const kParticleBytes = 12;
export const kBodyBytes = 28;
export const kFloaterBytes = 28;

/** 64-bit integers stay bigint: a number would round them beyond 2^53. */
export interface FrameHeader {
  tick: bigint;
  /** Number of the room's state that the frame shows: ticks repeat while the room is paused. 0: an older server. */
  stateId: bigint;
  /** Simulation time. */
  timeS: number;
  /** Server time of the simulated state. */
  serverTimeS: number;
  level: LevelName;
}

/** Samples of a plane, row by row, x fastest. Sample (i, k) lies at x = (i + 1/2) sideM / resolutionCount - sideM / 2, z likewise with k. */
export interface PlaneExtents {
  /** Along x. */
  resolutionCount: number;
  sideM: number;
  /** Along z. */
  countZ: number;
  widthM: number;
}

/** Returns whether samples of one plane lie where those of the other do. */
export function isLike(a: PlaneExtents, b: PlaneExtents): boolean {
  return a.resolutionCount === b.resolutionCount && a.countZ === b.countZ && a.sideM === b.sideM && a.widthM === b.widthM;
}

/** Elevation of a sample = int16 value * quantumM. */
export interface SurfaceHeader extends FrameHeader, PlaneExtents {
  quantumM: number;
}

/** Per axis: position = wordMin + u16 / 65535 (wordMax - wordMin), velocity = i8 / 127 maxSpeedMps. Metres, axes x, y, z. */
export interface ParticleHeader extends FrameHeader {
  count: number;
  /** Bounds of the particles. */
  minM: [number, number, number];
  maxM: [number, number, number];
  /** Positions of the words 0 and 65535. */
  wordMinM: [number, number, number];
  wordMaxM: [number, number, number];
  maxSpeedMps: number;
  radiusM: number;
}

/** One byte per sample, 0 none to 255 white; samples lie as those of the surface. */
export interface FoamHeader extends FrameHeader, PlaneExtents {}

interface BodiesHeader extends FrameHeader {
  count: number;
}

/** Coordinates are whole numbers of quanta; a rotation has any length. */
interface FloatersHeader extends FrameHeader {
  count: number;
  quantumM: number;
}

/** The header of each layer's plain frames. */
export interface FrameHeaders extends Record<FrameLayer, FrameHeader> {
  surface: SurfaceHeader;
  particles: ParticleHeader;
  foam: FoamHeader;
  bodies: BodiesHeader;
  floaters: FloatersHeader;
}

export type PlainFrame = { [L in FrameLayer]: { kind: L; header: FrameHeaders[L]; payload: Uint8Array } }[FrameLayer];

/** A predicted plane: its residuals, and the weights of the prediction. */
export interface PackedPlane<H extends FrameHeader & PlaneExtents> {
  header: H;
  /** Tick of the frame that a delta builds on; undefined for a keyframe. */
  baseTick: bigint | undefined;
  weights: number[];
  /** Of a keyframe: the weights of the plane before it, which it contains as well. */
  earlierWeights: number[];
  payload: Uint8Array;
}

/** Particles sorted into the cells of a grid; always a keyframe. */
export interface PackedParticles {
  header: FrameHeader;
  count: number;
  minM: [number, number, number];
  /** Along x, y, z. */
  cellsCount: [number, number, number];
  cellM: number;
  /** Bits of a particle's offset inside its cell, per axis. */
  offsetBits: number;
  velocityQuantumMps: number;
  radiusM: number;
  payload: Uint8Array;
}

/** Objects predicted from the frame before. */
export interface PackedFloaters {
  header: FloatersHeader;
  /** Tick of the frame that a delta builds on; undefined for a keyframe. */
  baseTick: bigint | undefined;
  rotationBits: number;
  motionWeight: number;
  payload: Uint8Array;
}

export type PackedFrame =
  | ({ kind: "packedSurface" } & PackedPlane<SurfaceHeader>)
  | ({ kind: "packedFoam" } & PackedPlane<FoamHeader>)
  | ({ kind: "packedParticles" } & PackedParticles)
  | ({ kind: "packedFloaters" } & PackedFloaters);

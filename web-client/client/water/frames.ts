// Frames as typed arrays, in metres, seconds and radians. x and z lie level, y points up, y = 0 is the water at rest. What is computed from
// the streamed numbers is computed when it is first read.
import { bilinear } from "../codec/bilinear";
import { readBodies, type BodyPose } from "../codec/bodies";
import { readFloaters, type FloaterPose } from "../codec/floaters";
import { kParticleBytes, type FrameHeader, type FrameHeaders, type ParticleHeader, type PlainFrame, type PlaneExtents, type SurfaceHeader } from "../codec/frame_types";
import type { LayerName, LevelName } from "../codec/layers";
import type { DiagnosticsInfo } from "../codec/parse";

/** The state of a room after `tick`, one layer of it. */
export abstract class Frame {
  abstract readonly layer: LayerName;
  readonly tick: number;
  /** Frames with the same number show the same state, whatever their layer. */
  readonly stateId: number;
  /** Simulation time since the scene began or was reset. */
  readonly timeS: number;
  /** On the clock of the server. */
  readonly serverTimeS: number;
  /** Level of detail. */
  readonly level: LevelName;

  constructor({ tick, stateId, timeS, serverTimeS, level }: FrameHeader) {
    this.tick = Number(tick);
    this.stateId = Number(stateId);
    this.timeS = timeS;
    this.serverTimeS = serverTimeS;
    this.level = level;
  }
}

/** Samples at the centres of cells: sample k * countX + i lies at xM(i), zM(k). */
abstract class Plane extends Frame {
  readonly countX: number;
  readonly countZ: number;
  /** Extent along x. */
  readonly lengthM: number;
  /** Extent along z. */
  readonly widthM: number;

  constructor(header: FrameHeader & PlaneExtents) {
    super(header);
    this.countX = header.resolutionCount;
    this.countZ = header.countZ;
    this.lengthM = header.sideM;
    this.widthM = header.widthM;
  }

  xM(i: number): number {
    return (i + 0.5) * (this.lengthM / this.countX) - this.lengthM / 2;
  }

  zM(k: number): number {
    return (k + 0.5) * (this.widthM / this.countZ) - this.widthM / 2;
  }
}

export class Surface extends Plane {
  readonly layer = "surface";
  /** The samples are whole numbers of it. */
  readonly quantumM: number;
  /** As streamed: countX * countZ. */
  readonly samples: Int16Array;
  #heightsM: Float32Array | undefined;

  constructor(header: SurfaceHeader, payload: Uint8Array) {
    super(header);
    this.quantumM = header.quantumM;
    this.samples = new Int16Array(copyOf(payload));
  }

  /** Elevations over the water at rest, countX * countZ; on dry ground that of the ground. Off by at most half of quantumM. */
  get heightsM(): Float32Array {
    return (this.#heightsM ??= Float32Array.from(this.samples, (sample) => sample * this.quantumM));
  }

  /** Elevation at a position, bilinear between samples, as at the outermost sample beyond it. */
  heightM(xM: number, zM: number): number {
    const { lengthM, widthM, countX, countZ } = this;
    return this.quantumM * bilinear({ lengthXM: lengthM, lengthZM: widthM, countX, countZ }, xM, zM, (at) => this.samples[at]!);
  }
}

export class Foam extends Plane {
  readonly layer = "foam";
  /** 0 none to 255 white: countX * countZ. */
  readonly samples: Uint8Array;

  constructor(header: FrameHeaders["foam"], payload: Uint8Array) {
    super(header);
    this.samples = new Uint8Array(copyOf(payload));
  }
}

/** In any order, which may differ from frame to frame. */
export class Particles extends Frame {
  readonly layer = "particles";
  readonly count: number;
  /** Half the spacing at rest. */
  readonly radiusM: number;
  readonly #header: ParticleHeader;
  readonly #bytes: DataView;
  #positionsM: Float32Array | undefined;
  #velocitiesMps: Float32Array | undefined;

  constructor(header: ParticleHeader, payload: Uint8Array) {
    super(header);
    this.count = header.count;
    this.radiusM = header.radiusM;
    this.#header = header;
    this.#bytes = new DataView(copyOf(payload));
  }

  /** x, y, z of each: 3 * count. */
  get positionsM(): Float32Array {
    const { wordMinM, wordMaxM } = this.#header;
    // The order on the wire is x, z, y.
    return (this.#positionsM ??= this.#values(3, (at, axis) => wordMinM[axis]! + ((wordMaxM[axis]! - wordMinM[axis]!) * this.#bytes.getUint16(at + 2 * [0, 2, 1][axis]!, true)) / 65535));
  }

  /** x, y, z of each: 3 * count. */
  get velocitiesMps(): Float32Array {
    const unit = this.#header.maxSpeedMps / 127;
    return (this.#velocitiesMps ??= this.#values(3, (at, axis) => unit * this.#bytes.getInt8(at + 6 + axis)));
  }

  /** Density over that at rest. */
  get densityRatio(): Float32Array {
    return this.#values(1, (at) => 0.5 + (this.#bytes.getUint8(at + 9) * 0.6) / 255);
  }

  /** 0 clear to 1 white. */
  get foam(): Float32Array {
    return this.#values(1, (at) => this.#bytes.getUint8(at + 10) / 255);
  }

  #values(each: number, read: (at: number, axis: number) => number): Float32Array {
    const values = new Float32Array(each * this.count);
    for (let i = 0; i < values.length; ++i) values[i] = read(Math.trunc(i / each) * kParticleBytes, i % each);
    return values;
  }
}

/** Boats: arrays with one entry for each, in the order of `boats`. */
export class Boats extends Frame {
  readonly layer = "bodies";
  readonly boats: readonly BodyPose[];

  constructor(header: FrameHeaders["bodies"], payload: Uint8Array) {
    super(header);
    this.boats = readBodies(viewOf(payload), header.count);
  }

  get ids(): Uint32Array {
    return Uint32Array.from(this.boats, ({ boatId }) => boatId);
  }

  /** x, y, z of the middle between keel and deck: 3 * count. */
  get positionsM(): Float64Array {
    return Float64Array.from(this.boats.flatMap(({ xM, yM, zM }) => [xM, yM, zM]));
  }

  /** From +x toward +z. */
  get headingsRad(): Float64Array {
    return Float64Array.from(this.boats, ({ headingRad }) => headingRad);
  }

  /** Along the heading. */
  get speedsMps(): Float64Array {
    return Float64Array.from(this.boats, ({ speedMps }) => speedMps);
  }

  /** Undefined if the boat is not there (yet). */
  boat(boatId: number): BodyPose | undefined {
    return this.boats.find((each) => each.boatId === boatId);
  }
}

/** Objects in the water: arrays with one entry for each, in the order of `floaters`. */
export class Floaters extends Frame {
  readonly layer = "floaters";
  readonly floaters: readonly FloaterPose[];

  constructor(header: FrameHeaders["floaters"], payload: Uint8Array) {
    super(header);
    this.floaters = readFloaters(viewOf(payload), header.count, header.quantumM);
  }

  get ids(): Uint32Array {
    return Uint32Array.from(this.floaters, ({ floaterId }) => floaterId);
  }

  /** x, y, z of the middle: 3 * count. */
  get positionsM(): Float64Array {
    return Float64Array.from(this.floaters.flatMap(({ xM, yM, zM }) => [xM, yM, zM]));
  }

  /** Unit quaternions x, y, z, w from the object's own axes to those of the water: 4 * count. */
  get rotations(): Float64Array {
    return Float64Array.from(this.floaters.flatMap(({ turn }) => turn));
  }

  /** Longest extents. */
  get sizesM(): Float64Array {
    return Float64Array.from(this.floaters, ({ sizeM }) => sizeM);
  }
}

type Plain<T> = { [K in keyof T]: T[K] extends bigint ? number : T[K] };

/** What the server measures of the room, its gauges included. Fields as in wire.proto. */
export interface Diagnostics extends Plain<DiagnosticsInfo> {
  layer: "diagnostics";
}

/** Frames by layer. */
export interface Frames {
  surface: Surface;
  particles: Particles;
  foam: Foam;
  bodies: Boats;
  floaters: Floaters;
  diagnostics: Diagnostics;
}

/** The payload may be used again for the next frame: what is kept of it is copied. */
export function frameOf({ kind, header, payload }: PlainFrame): Surface | Particles | Foam | Boats | Floaters {
  switch (kind) {
    case "surface":
      return new Surface(header, payload);
    case "particles":
      return new Particles(header, payload);
    case "foam":
      return new Foam(header, payload);
    case "bodies":
      return new Boats(header, payload);
    case "floaters":
      return new Floaters(header, payload);
  }
}

export function diagnosticsOf(info: DiagnosticsInfo): Diagnostics {
  const numbers = Object.fromEntries(Object.entries(info).map(([name, value]) => [name, typeof value === "bigint" ? Number(value) : value]));
  return { layer: "diagnostics", ...(numbers as unknown as Plain<DiagnosticsInfo>) };
}

function copyOf(bytes: Uint8Array): ArrayBuffer {
  return bytes.slice().buffer as ArrayBuffer;
}

function viewOf({ buffer, byteOffset, byteLength }: Uint8Array): DataView {
  return new DataView(buffer, byteOffset, byteLength);
}

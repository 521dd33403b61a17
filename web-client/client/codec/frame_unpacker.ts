// Packed frames of every layer → plain ones, whose payload is valid until the next frame of its layer. A delta is predicted from the
// frame before it, which the reader keeps; packed particles need no other frame.
import { FloaterReader, ParticleReader, PlaneReader } from "./frame_reader";
import { isLike, type FoamHeader, type FrameHeader, type PackedFloaters, type PackedFrame, type PackedParticles, type PackedPlane, type ParticleHeader, type PlainFrame, type PlaneExtents, type SurfaceHeader } from "./frame_types";
import { malformed, type Malformed } from "./malformed";

const kMaxSignedByte = 127;
const kMaxWord = 65535;

/** The delta's base frame is missing: only a keyframe can be read. */
interface MissingBase {
  kind: "missingBase";
}

export class FrameUnpacker {
  private readonly surface = new PlaneHistory<SurfaceHeader>((a, b) => isLike(a, b) && a.quantumM === b.quantumM);
  private readonly foam = new PlaneHistory<FoamHeader>(isLike);
  private particles: ParticleReader | undefined;
  private readonly floaters = new FloaterHistory();

  /** Call it after a new subscription: no delta builds on earlier frames. */
  forget(): void {
    this.surface.forget();
    this.foam.forget();
    this.floaters.forget();
  }

  unpack(packed: PackedFrame): PlainFrame | Malformed | MissingBase {
    switch (packed.kind) {
      case "packedSurface": {
        const read = this.surface.unpack(packed);
        return "kind" in read ? read : { kind: "surface", header: packed.header, payload: read.surface(packed.header) };
      }
      case "packedFoam": {
        const read = this.foam.unpack(packed);
        return "kind" in read ? read : { kind: "foam", header: packed.header, payload: read.foam(packed.header) };
      }
      case "packedParticles":
        return unpackParticles((this.particles ??= new ParticleReader()), packed);
      case "packedFloaters":
        return this.floaters.unpack(packed);
    }
  }
}

/** Which frame of a layer was read last, and whether a delta can follow it. */
class History<P extends { header: FrameHeader; baseTick: bigint | undefined }> {
  /** Undefined if no delta can follow. */
  private last: P | undefined;

  /** `canFollow`: whether a frame can be predicted from one with the other header. */
  constructor(private readonly canFollow: (a: P, b: P) => boolean) {}

  forget(): void {
    this.last = undefined;
  }

  /** Reads the frame with `read`. A damaged one leaves no history. */
  take<R>(packed: P, what: string, read: (packed: P) => R | undefined): R | Malformed | MissingBase {
    const { last } = this;
    this.forget();
    if (packed.baseTick !== undefined && (!last || last.header.tick !== packed.baseTick || !this.canFollow(last, packed))) return { kind: "missingBase" };
    const result = read(packed);
    if (result === undefined) return malformed(`${what}: the payload's end does not fit its beginning`);
    this.last = packed;
    return result;
  }
}

/** The planes of one layer. */
class PlaneHistory<H extends FrameHeader & PlaneExtents> {
  private reader: PlaneReader | undefined;
  private readonly history: History<PackedPlane<H>>;

  constructor(canFollow: (a: H, b: H) => boolean) {
    this.history = new History((a, b) => canFollow(a.header, b.header));
  }

  forget(): void {
    this.history.forget();
  }

  /** Returns the reader with the samples. */
  unpack(packed: PackedPlane<H>): PlaneReader | Malformed | MissingBase {
    const reader = (this.reader ??= new PlaneReader());
    return this.history.take(packed, "a packed plane", ({ header, payload, weights, earlierWeights, baseTick }) => {
      const isRead = baseTick === undefined ? reader.readKeyframe(payload, header, weights, earlierWeights) : reader.readDelta(payload, header, weights);
      return isRead ? reader : undefined;
    });
  }
}

/** The objects in the water. */
class FloaterHistory extends History<PackedFloaters> {
  private reader: FloaterReader | undefined;

  constructor() {
    super((a, b) => a.header.level === b.header.level && a.header.quantumM === b.header.quantumM && a.rotationBits === b.rotationBits);
  }

  unpack(packed: PackedFloaters): PlainFrame | Malformed | MissingBase {
    const reader = (this.reader ??= new FloaterReader());
    return this.take<PlainFrame>(packed, "packed floaters", (frame) => {
      const payload = reader.read(frame);
      return payload && { kind: "floaters", header: frame.header, payload };
    });
  }
}

/** Header and ranges have been checked, so only the payload can be damaged. */
function unpackParticles(reader: ParticleReader, packed: PackedParticles): PlainFrame | Malformed {
  const { count, minM, cellsCount, cellM, offsetBits, velocityQuantumMps, radiusM } = packed;
  const payload = reader.read(packed.payload, count, cellsCount, offsetBits);
  if (!payload) return malformed(`particles: the payload does not hold ${count} of them`);
  // The reader writes positions in whole quanta, so the word 65535 lies 65,535 quanta above the word 0; likewise velocities.
  const quantumM = cellM / 2 ** offsetBits;
  const wordMinM = minM.map((min) => min + quantumM / 2) as ParticleHeader["wordMinM"];
  const header: ParticleHeader = {
    ...packed.header,
    count,
    minM,
    maxM: minM.map((min, axis) => min + cellsCount[axis]! * cellM) as ParticleHeader["maxM"],
    wordMinM,
    wordMaxM: wordMinM.map((min) => min + kMaxWord * quantumM) as ParticleHeader["wordMaxM"],
    maxSpeedMps: kMaxSignedByte * velocityQuantumMps,
    radiusM,
  };
  return { kind: "particles", header, payload };
}

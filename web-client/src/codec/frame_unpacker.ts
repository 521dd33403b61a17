// Packed frames of every layer → plain ones, whose payload is valid until the next frame of its layer. A delta of a plane is predicted
// from the plane before it, which the reader keeps; packed particles need no other frame.
import { ParticleReader, PlaneReader } from "./frame_reader";
import { isLike, type FoamHeader, type FrameHeader, type PackedFrame, type PackedParticles, type PackedPlane, type ParticleHeader, type PlainFrame, type PlaneExtents, type SurfaceHeader } from "./frame_types";
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

  /** Call it after a new subscription: no delta builds on earlier frames. */
  forget(): void {
    this.surface.forget();
    this.foam.forget();
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
    }
  }
}

/** The planes of one layer. */
class PlaneHistory<H extends FrameHeader & PlaneExtents> {
  private reader: PlaneReader | undefined;
  /** Header of the plane read last; undefined if no delta can follow it. */
  private last: H | undefined;

  /** `canFollow`: whether a plane can be predicted from one with the other header. */
  constructor(private readonly canFollow: (a: H, b: H) => boolean) {}

  forget(): void {
    this.last = undefined;
  }

  /** Returns the reader with the samples. */
  unpack({ header, payload, weights, earlierWeights, baseTick }: PackedPlane<H>): PlaneReader | Malformed | MissingBase {
    const { last } = this;
    // A damaged plane leaves no history.
    this.forget();
    const reader = (this.reader ??= new PlaneReader());
    if (baseTick !== undefined && (!last || last.tick !== baseTick || !this.canFollow(last, header))) return { kind: "missingBase" };
    const isRead = baseTick === undefined ? reader.readKeyframe(payload, header, weights, earlierWeights) : reader.readDelta(payload, header, weights);
    if (!isRead) return malformed("a packed plane: the payload's end does not fit its beginning");
    this.last = header;
    return reader;
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

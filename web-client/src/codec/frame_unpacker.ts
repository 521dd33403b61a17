// Packed frames of every layer → plain ones. A delta of a plane needs the plane before it; packed particles need no other frame.
import { ParticleReader } from "./frame_reader";
import { isLike, type FoamHeader, type PackedFrame, type PlainFrame, type SurfaceHeader } from "./frame_types";
import { isMalformed, type Malformed } from "./malformed";
import { PlaneHistory, type MissingBase } from "./plane_history";
import { unpackParticles } from "./unpack_particles";

export class FrameUnpacker {
  private readonly surface = new PlaneHistory<SurfaceHeader>(
    (a, b) => isLike(a, b) && a.quantumM === b.quantumM,
  );
  private readonly foam = new PlaneHistory<FoamHeader>(isLike);
  private particles: ParticleReader | undefined;

  /** Call it after a new subscription: no delta builds on earlier frames. */
  forget(): void {
    this.surface.forget();
    this.foam.forget();
  }

  /** The returned payload is valid until the next frame of its layer. */
  unpack(packed: PackedFrame): PlainFrame | Malformed | MissingBase {
    switch (packed.kind) {
      case "packedSurface": {
        const read = this.surface.unpack(packed);
        if (read.kind !== "samples") return read;
        return { kind: "surface", header: packed.header, payload: read.reader.surface(packed.header) };
      }
      case "packedFoam": {
        const read = this.foam.unpack(packed);
        if (read.kind !== "samples") return read;
        return { kind: "foam", header: packed.header, payload: read.reader.foam(packed.header) };
      }
      case "packedParticles": {
        const read = unpackParticles((this.particles ??= new ParticleReader()), packed);
        return isMalformed(read) ? read : { kind: "particles", ...read };
      }
    }
  }
}

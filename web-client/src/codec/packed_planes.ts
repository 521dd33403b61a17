// The packed forms of the layers that are planes → the samples of their plain ones. Keeps the last two planes of a layer, on
// which the next one builds.
import { PlaneReader } from "./frame_reader";
import type { FoamHeader, FrameHeader, SurfaceHeader } from "./frames";
import { malformed, type Malformed } from "./malformed";

/** A plane that takes those before to be read. */
export interface PackedPlane<H extends FrameHeader> {
  header: H;
  /** Samples along each side. */
  resolutionCount: number;
  /** The frame that it builds on; undefined: a keyframe. */
  baseTick: bigint | undefined;
  weights: number[];
  earlierWeights: number[];
  payload: Uint8Array;
}
export type PackedSurface = { kind: "packedSurface" } & PackedPlane<SurfaceHeader>;
export type PackedFoam = { kind: "packedFoam" } & PackedPlane<FoamHeader>;

/** The frame builds on one that is not here: only a keyframe helps. */
export interface MissingBase {
  kind: "missingBase";
}

/** One layer's row of planes. */
class PlaneRow<H extends FrameHeader> {
  private reader: PlaneReader | undefined;
  /** Of the plane read last; undefined: there is none to continue. */
  private header: H | undefined;

  /** `isSame`: whether planes of both headers can follow each other. */
  constructor(private readonly isSame: (a: H, b: H) => boolean) {}

  forget(): void {
    this.header = undefined;
  }

  read(packed: PackedPlane<H>): { kind: "plane"; reader: PlaneReader } | Malformed | MissingBase {
    const { header, resolutionCount, payload, weights, earlierWeights, baseTick } = packed;
    const known = this.header;
    this.forget(); // until this frame has proved good
    const reader = (this.reader ??= new PlaneReader());
    if (baseTick !== undefined && (!known || known.tick !== baseTick || !this.isSame(known, header))) return { kind: "missingBase" };
    const isRead =
      baseTick === undefined
        ? reader.readKeyframe(payload, resolutionCount, weights, earlierWeights)
        : reader.readDelta(payload, resolutionCount, weights);
    if (!isRead) return malformed("a packed plane: the payload's end does not fit its beginning");
    this.header = header;
    return { kind: "plane", reader };
  }
}

export class PlaneUnpacker {
  private readonly surface = new PlaneRow<SurfaceHeader>(
    (a, b) => a.resolutionCount === b.resolutionCount && a.sideM === b.sideM && a.quantumM === b.quantumM,
  );
  private readonly foam = new PlaneRow<FoamHeader>((a, b) => a.resolutionCount === b.resolutionCount && a.sideM === b.sideM);

  /** Another subscription: nothing that came before counts. */
  forget(): void {
    this.surface.forget();
    this.foam.forget();
  }

  /** The payload that comes back holds until the next frame of its layer. */
  unpack(
    packed: PackedSurface | PackedFoam,
  ):
    | { kind: "surface"; header: SurfaceHeader; payload: Uint8Array }
    | { kind: "foam"; header: FoamHeader; payload: Uint8Array }
    | Malformed
    | MissingBase {
    if (packed.kind === "packedSurface") {
      const read = this.surface.read(packed);
      return read.kind === "plane" ? { kind: "surface", header: packed.header, payload: read.reader.surface(packed.resolutionCount) } : read;
    }
    const read = this.foam.read(packed);
    return read.kind === "plane" ? { kind: "foam", header: packed.header, payload: read.reader.foam(packed.resolutionCount) } : read;
  }
}

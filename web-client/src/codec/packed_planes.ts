// The packed forms of the layers that are planes → the samples of their plain ones. Keeps the last two planes of a layer, on
// which the next one builds.
import type { FoamHeader, FrameHeader, SurfaceHeader } from "./frames";
import { malformed, type Malformed } from "./malformed";
import { ResidualReader } from "./residual_reader";
import { readPlane, SurfacePlane } from "./surface_predictor";

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
  private before: SurfacePlane | undefined;
  private earlier: SurfacePlane | undefined;
  private header: H | undefined;

  /** `isSame`: whether planes of both headers can follow each other. */
  constructor(private readonly isSame: (a: H, b: H) => boolean) {}

  forget(): void {
    this.before = this.earlier = undefined;
    this.header = undefined;
  }

  read(packed: PackedPlane<H>): { kind: "plane"; samples: Int16Array } | Malformed | MissingBase {
    const { header, resolutionCount, payload, weights, earlierWeights, baseTick } = packed;
    const { before, earlier: beforeThat, header: known } = this;
    this.forget(); // until this frame has proved good
    const reader = new ResidualReader(payload);
    const now = new SurfacePlane(resolutionCount);
    let earlier = before;
    if (baseTick === undefined) {
      readPlane(reader, {}, weights, now);
      earlier = new SurfacePlane(resolutionCount);
      readPlane(reader, { before: now }, earlierWeights, earlier);
    } else {
      if (!known || known.tick !== baseTick || !this.isSame(known, header)) return { kind: "missingBase" };
      readPlane(reader, { before, earlier: beforeThat }, weights, now);
    }
    if (!reader.isAtEnd()) return malformed("a packed plane: the payload's end does not fit its beginning");
    this.before = now;
    this.earlier = earlier;
    this.header = header;
    const samples = new Int16Array(resolutionCount * resolutionCount);
    now.copyTo(samples);
    return { kind: "plane", samples };
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

  unpack(
    packed: PackedSurface | PackedFoam,
  ):
    | { kind: "surface"; header: SurfaceHeader; payload: Uint8Array }
    | { kind: "foam"; header: FoamHeader; payload: Uint8Array }
    | Malformed
    | MissingBase {
    if (packed.kind === "packedSurface") {
      const read = this.surface.read(packed);
      return read.kind === "plane" ? { kind: "surface", header: packed.header, payload: new Uint8Array(read.samples.buffer) } : read;
    }
    const read = this.foam.read(packed);
    return read.kind === "plane" ? { kind: "foam", header: packed.header, payload: Uint8Array.from(new Uint8ClampedArray(read.samples)) } : read;
  }
}

// The surface's packed form → the samples of its plain one. Keeps the last two frames, on which the next one builds.
import type { PackedSurface, SurfaceHeader } from "./frames";
import type { Malformed } from "./malformed";
import { ResidualReader } from "./residual_reader";
import { readPlane, SurfacePlane } from "./surface_predictor";

/** The frame builds on one that is not here: only a keyframe helps. */
export interface MissingBase {
  kind: "missingBase";
}

export class SurfaceUnpacker {
  private before: SurfacePlane | undefined;
  private earlier: SurfacePlane | undefined;
  private header: SurfaceHeader | undefined;

  /** Another subscription: nothing that came before counts. */
  forget(): void {
    this.before = this.earlier = undefined;
    this.header = undefined;
  }

  unpack(packed: PackedSurface): { kind: "surface"; header: SurfaceHeader; payload: Uint8Array } | Malformed | MissingBase {
    const { header, payload, weights, earlierWeights, baseTick } = packed;
    const n = header.resolutionCount;
    const reader = new ResidualReader(payload);
    let before = this.before;
    let earlier = this.earlier;
    const known = this.header;
    this.forget(); // until this frame has proved good
    const now = new SurfacePlane(n);
    if (baseTick === undefined) {
      readPlane(reader, {}, weights, now);
      earlier = new SurfacePlane(n);
      readPlane(reader, { before: now }, earlierWeights, earlier);
    } else {
      if (known?.tick !== baseTick || known.resolutionCount !== n || known.sideM !== header.sideM || known.quantumM !== header.quantumM)
        return { kind: "missingBase" };
      readPlane(reader, { before, earlier }, weights, now);
      earlier = before;
    }
    if (!reader.isAtEnd()) return { kind: "malformed", reason: "surface: the payload's end does not fit its beginning" };
    before = now;
    this.before = before;
    this.earlier = earlier;
    this.header = header;
    const samples = new Int16Array(n * n);
    now.copyTo(samples);
    return { kind: "surface", header, payload: new Uint8Array(samples.buffer) };
  }
}

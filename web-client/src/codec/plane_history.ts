// Unpacks the planes of one layer. A delta is predicted from the plane before it, which the reader keeps.
import { PlaneReader } from "./frame_reader";
import type { FrameHeader, PackedPlane, PlaneExtents } from "./frame_types";
import { malformed, type Malformed } from "./malformed";

/** The delta's base frame is missing: only a keyframe can be read. */
export interface MissingBase {
  kind: "missingBase";
}

export class PlaneHistory<H extends FrameHeader & PlaneExtents> {
  private reader: PlaneReader | undefined;
  /** Header of the plane read last; undefined if no delta can follow it. */
  private last: H | undefined;

  /** `canFollow`: whether a plane can be predicted from one with the other header. */
  constructor(private readonly canFollow: (a: H, b: H) => boolean) {}

  forget(): void {
    this.last = undefined;
  }

  /** The samples are in the returned reader until the next call. */
  unpack(packed: PackedPlane<H>): { kind: "samples"; reader: PlaneReader } | Malformed | MissingBase {
    const { header, payload, weights, earlierWeights, baseTick } = packed;
    const { last } = this;
    // A damaged plane leaves no history.
    this.forget();
    const reader = (this.reader ??= new PlaneReader());
    if (baseTick !== undefined && (!last || last.tick !== baseTick || !this.canFollow(last, header))) return { kind: "missingBase" };
    const isRead =
      baseTick === undefined
        ? reader.readKeyframe(payload, header, weights, earlierWeights)
        : reader.readDelta(payload, header, weights);
    if (!isRead) return malformed("a packed plane: the payload's end does not fit its beginning");
    this.last = header;
    return { kind: "samples", reader };
  }
}

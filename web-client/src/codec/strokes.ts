// The fingers in the water, as plain data that survives postMessage.
import type { Finger, Strokes } from "../gen/spindrift/v1/wire_pb";
import { malformed, type Malformed } from "./malformed";

export type FingerInfo = Pick<Finger, "personId" | "strokeId" | "xM" | "zM">;

export function readStrokes({ fingers }: Strokes): { fingers: FingerInfo[] } | Malformed {
  if (!fingers.every(({ xM, zM }) => Number.isFinite(xM) && Number.isFinite(zM))) return malformed("strokes: a position is not finite");
  return { fingers: fingers.map(({ personId, strokeId, xM, zM }) => ({ personId, strokeId, xM, zM })) };
}

// The fingers in the water, as plain data that survives postMessage.
import type { Finger, Strokes } from "../gen/spindrift/v1/wire_pb";
import { malformed, type Malformed } from "./malformed";

export type FingerInfo = Pick<Finger, "personId" | "strokeId" | "xM" | "zM" | "radiusM" | "tool">;

export function readStrokes({ fingers }: Strokes): { fingers: FingerInfo[] } | Malformed {
  if (!fingers.every(({ xM, zM, radiusM }) => [xM, zM, radiusM].every(Number.isFinite))) return malformed("strokes: a position or a radius is not finite");
  return { fingers: fingers.map(({ personId, strokeId, xM, zM, radiusM, tool }) => ({ personId, strokeId, xM, zM, radiusM, tool })) };
}

// The fingers in the water, as plain data that survives postMessage.
import type { Strokes } from "../gen/spindrift/v1/wire_pb";
import { malformed, type Malformed } from "./malformed";

export interface FingersInfo {
  /** Simulation time. */
  timeS: number;
  fingers: { personId: number; strokeId: number; xM: number; zM: number; radiusM: number }[];
}

export function readStrokes({ timeS, fingers }: Strokes): { list: FingersInfo } | Malformed {
  if (!Number.isFinite(timeS) || !fingers.every(({ xM, zM, radiusM }) => [xM, zM, radiusM].every(Number.isFinite))) return malformed("strokes: a number is not finite");
  return { list: { timeS, fingers: fingers.map(({ personId, strokeId, xM, zM, radiusM }) => ({ personId, strokeId, xM, zM, radiusM })) } };
}

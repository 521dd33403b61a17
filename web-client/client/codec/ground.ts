// The ground of a scene with a bed, as the server sends it (GET /api/v1/rooms/ROOM/ground).
import { fromBinary } from "@bufbuild/protobuf";

import { GroundSchema, type Ground } from "../gen/spindrift/v1/api_pb";
import { malformed, type Malformed } from "./malformed";

/** The server's largest count of cells along a side. */
const kMaxCount = 4096;

/** Heights over the rest level at the centres of cells; x fastest, from the smallest x and z. */
export interface GroundGrid {
  countX: number;
  countZ: number;
  lengthM: number;
  widthM: number;
  riseM: Float32Array;
}

function parse(bytes: Uint8Array): Ground | undefined {
  try {
    return fromBinary(GroundSchema, bytes);
  } catch {
    return undefined;
  }
}

/** Malformed if the bytes are not ground of a sensible size. */
export function readGround(bytes: Uint8Array): { ground: GroundGrid } | Malformed {
  const message = parse(bytes);
  if (!message) return malformed("ground: no spindrift.v1.Ground");
  const { countX, countZ, lengthM, widthM, quantumM, rise } = message;
  const isCount = (count: number): boolean => count >= 1 && count <= kMaxCount;
  if (!isCount(countX) || !isCount(countZ) || rise.length !== countX * countZ)
    return malformed(`ground: ${rise.length} heights for ${countX} x ${countZ} cells`);
  if (![lengthM, widthM, quantumM].every((size) => size > 0 && size <= 1e6)) return malformed(`ground: ${lengthM} m by ${widthM} m in steps of ${quantumM} m`);
  const steps = new Int32Array(rise.length);
  const riseM = new Float32Array(rise.length);
  for (let i = 0; i < rise.length; ++i) {
    const before = i % countX !== 0 ? i - 1 : i - countX;
    steps[i] = rise[i]! + (before >= 0 ? steps[before]! : 0);
    riseM[i] = steps[i]! * quantumM;
  }
  return { ground: { countX, countZ, lengthM, widthM, riseM } };
}

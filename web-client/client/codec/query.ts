// The answers to queries about the water at points, as typed arrays.
import type { QueryAnswer, QueryResult } from "../gen/spindrift/v1/wire_pb";
import { malformed, type Malformed } from "./malformed";

export interface QueryAnswerInfo {
  tick: number;
  timeS: number;
  stateId: number;
  results: {
    queryId: number;
    /** Why the query ends without values; empty: it has them. */
    ended: string;
    values: ReturnType<typeof valuesOf>;
  }[];
}

function valuesOf(result: QueryResult) {
  const { elevationM, verticalSpeedMps, velocityXMps, velocityZMps, slopeX, slopeZ, depthM, wetRatio, foamRatio } = result;
  const numbers = { elevationM, verticalSpeedMps, velocityXMps, velocityZMps, slopeX, slopeZ, depthM, wetRatio, foamRatio };
  const outside = new Uint8Array(elevationM.length);
  for (const point of result.outside) outside[point] = 1;
  return { ...(Object.fromEntries(Object.entries(numbers).map(([name, values]) => [name, Float32Array.from(values)])) as Record<keyof typeof numbers, Float32Array>), outside };
}

export function readQueryAnswer({ tick, timeS, stateId, results }: QueryAnswer): QueryAnswerInfo | Malformed {
  const read = results.map((result) => ({ queryId: result.queryId, ended: result.ended, values: valuesOf(result) }));
  for (const { queryId, values } of read)
    if (Object.values(values).some(({ length }) => length !== values.outside.length)) return malformed(`query ${queryId}: arrays of different lengths`);
  return { tick: Number(tick), timeS, stateId: Number(stateId), results: read };
}

// The water at points: single answers, and streams of them.
import type { QueryAnswerInfo } from "../codec/query";
import type { CommandAction } from "../session/events";
import type { Ack } from "./commands";
import { NoAnswer, SpindriftError } from "./errors";
import { FrameStream } from "./frame_stream";

/** Positions or velocities along x and z: pairs, or the numbers one after another. */
export type Pairs = readonly (readonly [number, number])[] | Float32Array | Float64Array;

/** The water at the points of a query, after `tick`: arrays with one entry per point, in their order. Of elevation, speeds and slopes only wet
 *  cells count; on dry ground alone elevationM is that of the ground where water can come, and otherwise 0. */
export interface Answer {
  tick: number;
  /** Simulation time since the scene began or was reset. */
  timeS: number;
  /** As of frames: those with the same number show the same water. */
  stateId: number;
  /** Over the water at rest. */
  elevationM: Float32Array;
  /** Rate at which the elevation at the position changes. */
  verticalSpeedMps: Float32Array;
  /** Of the water, as a mean over its depth. */
  velocityXMps: Float32Array;
  velocityZMps: Float32Array;
  /** Of the elevation along x and z. */
  slopeX: Float32Array;
  slopeZ: Float32Array;
  /** From the bed to the surface. */
  depthM: Float32Array;
  /** Share of wet cells around the point. */
  wetRatio: Float32Array;
  /** Share of white water. */
  foamRatio: Float32Array;
  /** 1: the point lies outside of the water, and its values are 0. */
  outside: Uint8Array;
}

export interface QueryStreamOptions {
  /** With which the points move, m/s: one pair for all points, or one each. At rest if left out. */
  velocities?: Pairs;
  /** An answer whenever so many ticks have passed. 1 if left out. */
  intervalTicks?: number;
  /** Answers that wait, 1 to 4096; then the oldest are dropped and counted. 64 if left out. */
  capacity?: number;
}

const kWaitingAnswers = 64;

/** What is asked over one connection. */
export class Queries {
  private nextId = 1;
  private readonly streams = new Map<number, FrameStream<Answer>>();

  /** `send`: sends a command and gives its Ack; rejects as commands do. */
  constructor(private readonly send: (action: CommandAction) => Promise<Ack>) {}

  /** One answer, after at most so many seconds from the Ack on. */
  async once(points: Pairs, withinS: number): Promise<Answer> {
    const [queryId, stream] = this.open(1);
    let timer;
    try {
      await this.send({ case: "query", value: { queryId, ...fieldsOf(points) } });
      const late = new Promise<never>((_, reject) => (timer = setTimeout(() => reject(new NoAnswer(`the water at the points did not come within ${withinS} s`)), withinS * 1000)));
      return (await Promise.race([stream.next(), late])).value;
    } finally {
      clearTimeout(timer);
      this.streams.delete(queryId);
    }
  }

  stream(points: Pairs, { velocities, intervalTicks = 1, capacity = kWaitingAnswers }: QueryStreamOptions): FrameStream<Answer> {
    if (!(Number.isInteger(intervalTicks) && intervalTicks >= 1)) throw new RangeError(`intervalTicks ${intervalTicks}: expected a whole number above 0`);
    const fields = fieldsOf(points, velocities);
    const [queryId, stream] = this.open(capacity);
    this.send({ case: "query", value: { queryId, intervalTicks, ...fields } }).catch((error: Error) => {
      this.streams.delete(queryId);
      stream.finish(error);
    });
    return stream;
  }

  take({ tick, timeS, stateId, results }: QueryAnswerInfo): void {
    for (const { queryId, ended, values } of results) {
      const stream = this.streams.get(queryId);
      if (!stream) continue;
      if (ended === "") stream.put({ tick, timeS, stateId, ...values });
      else {
        this.streams.delete(queryId);
        stream.finish(new SpindriftError(`the query has ended: ${ended}`));
      }
    }
  }

  /** The connection is gone, and with it all queries. Without an error streams just end. */
  endAll(error: Error | undefined): void {
    for (const stream of this.streams.values()) stream.finish(error);
    this.streams.clear();
  }

  private open(capacity: number): [number, FrameStream<Answer>] {
    const queryId = this.nextId;
    this.nextId = (this.nextId % 0xffffffff) + 1;
    const stream = new FrameStream<Answer>(capacity, () => {
      // A query without points ends a stream. If that cannot be sent, the connection is gone.
      if (this.streams.delete(queryId)) this.send({ case: "query", value: { queryId } }).catch(() => {});
    });
    this.streams.set(queryId, stream);
    return [queryId, stream];
  }
}

/** Throws a TypeError for anything but pairs, and a RangeError for counts that do not fit. */
function fieldsOf(points: Pairs, velocities?: Pairs): { xM: number[]; zM: number[]; velocityXMps?: number[]; velocityZMps?: number[] } {
  const [xM, zM] = columnsOf(points, "points");
  if (xM.length === 0) throw new RangeError("points: the list is empty, give at least one [x, z]");
  if (!velocities) return { xM, zM };
  const [velocityXMps, velocityZMps] = columnsOf(velocities, "velocities");
  if (velocityXMps.length !== 1 && velocityXMps.length !== xM.length) throw new RangeError(`velocities: ${velocityXMps.length} pairs for ${xM.length} points; expected 1 or ${xM.length}`);
  return { xM, zM, velocityXMps, velocityZMps };
}

function columnsOf(pairs: Pairs, what: string): [number[], number[]] {
  const flat: readonly unknown[] = pairs instanceof Float32Array || pairs instanceof Float64Array ? [...pairs] : pairs.flatMap((pair) => (Array.isArray(pair) && pair.length === 2 ? (pair as unknown[]) : [undefined]));
  if (flat.length % 2 !== 0 || !flat.every((value) => typeof value === "number")) throw new TypeError(`${what}: expected [[x, z], ...], or a Float32Array of x and z in turn`);
  const numbers = flat as readonly number[];
  return [numbers.filter((_, k) => k % 2 === 0), numbers.filter((_, k) => k % 2 === 1)];
}

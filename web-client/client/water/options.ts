// What a Water is asked for and gives besides frames, as plain data.
import type { LevelName } from "../codec/layers";

/** How a layer is wanted. */
export interface LayerOptions {
  /** Frames per second, at most 240; 0 ends them. 60 if left out. */
  rateHz?: number;
  /** A tenth of the bytes; the same surfaces, foam and boats, coarser particles. True if left out. */
  packed?: boolean;
  /** "full" if left out. */
  level?: LevelName;
  /** The server may send coarser levels while the connection is slow. False if left out. */
  adapts?: boolean;
}

/** What a gauge measured at the last ticks, oldest first: arrays of one length. */
export interface GaugeRecord {
  /** Simulation time since the scene began or was reset. */
  timeS: Float64Array;
  /** Over the water at rest. */
  elevationM: Float64Array;
  /** Of the flow, as a mean over its depth. */
  velocityXMps: Float64Array;
  velocityZMps: Float64Array;
}

export interface WaterSettings {
  socketUrl: string;
  name: string;
  token: string;
  resumeKey: string;
  client: string;
  answerWithinS: number;
}

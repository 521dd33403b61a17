// What a connection takes and reports, as plain data.
import type { MessageInitShape } from "@bufbuild/protobuf";

import type { PackedFrame, PlainFrame } from "../codec/frame_types";
import type { LayerName, LevelName } from "../codec/layers";
import type { Malformed } from "../codec/malformed";
import type { ParsedMessage } from "../codec/parse";
import type { CommandSchema } from "../gen/spindrift/v1/wire_pb";

/** A command's action as plain data: one member of the oneof in wire.proto. */
export type CommandAction = Exclude<NonNullable<MessageInitShape<typeof CommandSchema>["action"]>, { case: undefined }>;

/** The user's data in Hello. */
export interface Identity {
  name: string;
  /** Gives a role; empty for a guest. */
  token: string;
  /** From an earlier Welcome, or empty. */
  resumeKey: string;
}

export type ConnectionState =
  | { name: "connecting" }
  /** The room does not exist yet. */
  | { name: "opening"; room: string }
  | { name: "live" }
  | { name: "retrying"; inS: number; why: string }
  /** `rooms`: those that there are, if the wanted one does not exist. */
  | { name: "refused"; reason: string; rooms: string[] };

/** One layer as the client wants it; at 0 Hz it ends. */
export interface Subscription {
  layer: LayerName;
  maxRateHz: number;
  /** A tenth of the bytes; the same surfaces, foam and boats, coarser particles. */
  packed: boolean;
  level: LevelName;
  /** The server may send coarser levels while the connection is slow. */
  adapts: boolean;
}

/** Rates over the last half second; counts since the beginning. */
export interface LinkStats {
  kilobytesPerS: number;
  framesPerS: number;
  /** Shortest round trip of the last pings; undefined before the first pong. */
  latencyMs: number | undefined;
  /** Share of the time that was spent on messages, 0..1. */
  busyShare: number;
  receivedCount: Record<LayerName, number>;
  malformedCount: number;
  lastMalformed: string;
  /** The finest level that the server sends to adapting subscriptions. */
  linkLevel: LevelName;
}

/** Why a command has no answer of the server: it was not sent; the connection broke or no answer came after it was, so that it may have been
 *  carried out. */
export type LocalReason = "NOT_SENT" | "LOST" | "NO_ANSWER";

/** Messages that the connection handles itself. */
type Handled = PlainFrame | PackedFrame | Malformed | { kind: "unknown" | "levelChanged" | "pong" | "refusal" | "queryAnswer" | "hullForces" };

/** What the connection reports besides frames. A reject may be one of its own, with a LocalReason. */
export type ConnectionEvent =
  | Exclude<ParsedMessage, { kind: Handled["kind"] }>
  | { kind: "state"; state: ConnectionState }
  /** The server's clock minus Unix time [s]. */
  | { kind: "clock"; leadS: number }
  | { kind: "stats"; stats: LinkStats };

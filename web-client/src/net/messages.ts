// What the page and the worker say to each other by postMessage. Frames travel as transferred ArrayBuffers; the page
// gives every one back with "release", which is what bounds the frames under way.
import type { MessageInitShape } from "@bufbuild/protobuf";

import type { BodiesHeader, FoamHeader, ParticleHeader, SurfaceHeader } from "../codec/frames";
import type { BoatDetail, GreetingInfo } from "../codec/greeting";
import type { LevelName } from "../codec/level";
import type { DiagnosticsInfo, RoomEventName } from "../codec/parse";
import type { PersonInfo, WelcomeInfo } from "../codec/people";
import type { CommandSchema } from "../gen/spindrift/v1/wire_pb";

/** A command's action as plain data, one member of the oneof in wire.proto. */
export type CommandAction = Exclude<
  NonNullable<MessageInitShape<typeof CommandSchema>["action"]>,
  { case: undefined }
>;

/** Who says hello. */
export interface Identity {
  name: string;
  /** Gives a role; empty: a guest. */
  token: string;
  /** Of an earlier welcome, or empty. */
  resumeKey: string;
}

export type ConnectionState =
  | { name: "connecting" }
  | { name: "live" }
  | { name: "retrying"; inS: number; why: string }
  | { name: "refused"; reason: string };

/** What the person chose: a level of detail, or whatever link and device can carry. */
export type DetailChoice = "auto" | LevelName;

export type FrameLayer = "surface" | "particles" | "foam" | "bodies";

export interface SurfaceFrame extends SurfaceHeader {
  layer: "surface";
  /** resolutionCount^2 little-endian int16. */
  buffer: ArrayBuffer;
}

export interface ParticleFrame extends ParticleHeader {
  layer: "particles";
  /** 12 bytes a particle, as on the wire; may be longer than `count` of them. */
  buffer: ArrayBuffer;
}

export interface FoamFrame extends FoamHeader {
  layer: "foam";
  /** resolutionCount^2 bytes. */
  buffer: ArrayBuffer;
}

export interface BodiesFrame extends BodiesHeader {
  layer: "bodies";
  /** 28 bytes a boat, as on the wire; may be longer than `count` of them. */
  buffer: ArrayBuffer;
}

export type Frame = SurfaceFrame | ParticleFrame | FoamFrame | BodiesFrame;

/** Measured over the last half second; counts since the page was opened. */
export interface LinkStats {
  kilobytesPerS: number;
  framesPerS: number;
  /** Lowest round trip of the last pings, or undefined before the first answer. */
  latencyMs: number | undefined;
  receivedCount: Record<FrameLayer | "diagnostics", number>;
  malformedCount: number;
  lastMalformed: string;
  /** Frames that a newer one overtook because the page was busy. */
  overtakenCount: number;
  /** The most that surface and particles come at now, and who holds it down. */
  level: LevelName;
  levelHeldBy: "nobody" | "choice" | "link" | "device";
}

export type PageToWorker =
  | { type: "start"; url: string; identity: Identity }
  | { type: "introduce"; name: string; token: string }
  | { type: "command"; commandId: number; action: CommandAction }
  | { type: "release"; layer: FrameLayer; buffer: ArrayBuffer }
  | { type: "detail"; detail: DetailChoice }
  | { type: "visible"; visible: boolean }
  | { type: "retry" };

export type WorkerToPage =
  | { type: "state"; state: ConnectionState }
  | { type: "greeting"; greeting: GreetingInfo }
  | { type: "frame"; frame: Frame }
  | { type: "diagnostics"; diagnostics: DiagnosticsInfo }
  | { type: "ack"; commandId: number; appliedTick: number; boatId: number }
  | { type: "reject"; commandId: number; reason: string; field: string; message: string }
  | { type: "parameterChanged"; path: string; value: number }
  | { type: "roomState"; paused: boolean; speed: number }
  | { type: "welcome"; welcome: WelcomeInfo }
  | { type: "people"; people: PersonInfo[] }
  | { type: "boatList"; boats: BoatDetail[] }
  | { type: "roomEvent"; event: RoomEventName; message: string }
  /** The server's clock minus Unix time [s], corrected. */
  | { type: "clock"; leadS: number }
  | { type: "stats"; stats: LinkStats };

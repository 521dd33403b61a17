// Messages between the page and the worker. The server's messages pass as codec/parse.ts declares them; calls to the connection
// pass as ConnectionCalls declares them. Frames travel as transferred ArrayBuffers: the page returns every one with
// "release", which bounds the frames on their way.
import type { MessageInitShape } from "@bufbuild/protobuf";

import type { FrameHeaders, PackedFrame, PlainFrame } from "../codec/frame_types";
import type { GroundGrid } from "../codec/ground";
import type { FrameLayer, LayerName, LevelName } from "../codec/layers";
import type { Malformed } from "../codec/malformed";
import type { ParsedMessage } from "../codec/parse";
import type { CommandSchema } from "../gen/spindrift/v1/wire_pb";
import type { RoomWish } from "./room_address";

/** A command's action as plain data: one member of the oneof in wire.proto. */
export type CommandAction = Exclude<
  NonNullable<MessageInitShape<typeof CommandSchema>["action"]>,
  { case: undefined }
>;

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
  /** The page's room does not exist yet. */
  | { name: "opening"; room: string }
  | { name: "live" }
  | { name: "retrying"; inS: number; why: string }
  /** `rooms`: those that there are, if the page's room does not exist. */
  | { name: "refused"; reason: string; rooms: string[] };

/** The user's choice: a level of detail, or automatic. */
export type DetailChoice = "auto" | LevelName;

/** A plain frame whose payload is in a buffer of its own, which may be longer than the payload. */
type FrameOf<L extends FrameLayer> = FrameHeaders[L] & { layer: L; buffer: ArrayBuffer };
export type SurfaceFrame = FrameOf<"surface">;
export type ParticleFrame = FrameOf<"particles">;
export type FoamFrame = FrameOf<"foam">;
export type BodiesFrame = FrameOf<"bodies">;
export type FloatersFrame = FrameOf<"floaters">;
export type Frame = { [L in FrameLayer]: FrameOf<L> }[FrameLayer];

/** Rates over the last half second; counts since the page was opened. */
export interface LinkStats {
  kilobytesPerS: number;
  framesPerS: number;
  /** Shortest round trip of the last pings; undefined before the first pong. */
  latencyMs: number | undefined;
  receivedCount: Record<LayerName, number>;
  malformedCount: number;
  lastMalformed: string;
  /** Finest level at which surface and particles are sent now, and what limits it. */
  level: LevelName;
  levelLimitedBy: "none" | "choice" | "link" | "device";
}

/** Messages that the connection handles itself. All others go to the page. */
type Handled = PlainFrame | PackedFrame | Malformed | { kind: "unknown" | "levelChanged" | "pong" | "refusal" };

/** What the connection reports besides frames. */
export type ConnectionEvent =
  | Exclude<ParsedMessage, { kind: Handled["kind"] }>
  | { kind: "state"; state: ConnectionState }
  /** The server's clock minus Unix time [s]. */
  | { kind: "clock"; leadS: number }
  | { kind: "stats"; stats: LinkStats };

export type PageEvent =
  | Exclude<ConnectionEvent, { kind: "stats" }>
  | { kind: "frame"; frame: Frame }
  /** `supersededCount`: frames dropped for newer ones because the page was busy. */
  | { kind: "stats"; stats: LinkStats; supersededCount: number };

/** What the worker says to a request for the ground: the ground, or why there is none, for people. */
export type GroundAnswer = { kind: "ground"; requestId: number } & ({ ground: GroundGrid } | { why: string });

/** One handler per event; a missing one does not compile. */
export type PageEventHandlers = { [K in PageEvent["kind"]]: (event: Extract<PageEvent, { kind: K }>) => void };

/** The methods of the connection that the page calls. */
export interface ConnectionCalls {
  /** Connects anew with another name or token; the server resumes the same person if it still can. */
  introduce(name: string, token: string): void;
  /** Exactly one ack or reject follows: the server's, or a local one if nothing was sent or no answer came. */
  command(commandId: number, action: CommandAction): void;
  setDetail(detail: DetailChoice): void;
  /** Particles in the plain packing: finer velocities and densities, and more bytes. */
  setExactParticles(exact: boolean): void;
  /** The layers that the page shows, of those that the room has; all unless called. */
  setLayers(layers: readonly LayerName[]): void;
  /** Frames of each layer per second, at most. */
  setFrameRate(maxHz: number): void;
  /** A hidden page gets no frames; showing it again subscribes to them again. */
  setVisible(visible: boolean): void;
  /** Connects now: after a refusal, or instead of waiting. */
  retryNow(): void;
}

type Call = { [K in keyof ConnectionCalls]: { kind: "call"; name: K; args: Parameters<ConnectionCalls[K]> } }[keyof ConnectionCalls];

export type WorkerRequest =
  | Call
  /** `language`: of the connection's lines for people. */
  | { kind: "start"; url: string; identity: Identity; wish: RoomWish | undefined; language: string }
  | { kind: "ground"; requestId: number; address: string; room: string; token: string }
  | { kind: "release"; layer: FrameLayer; buffer: ArrayBuffer };

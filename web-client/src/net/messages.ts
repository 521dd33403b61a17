// Messages between the page and the worker. The server's messages pass as client/codec/parse.ts declares them; calls to the session
// pass as its methods declare them. Frames travel as transferred ArrayBuffers: the page returns every one with
// "release", which bounds the frames on their way.
import type { FrameHeaders } from "../../client/codec/frame_types";
import type { GroundGrid } from "../../client/codec/ground";
import type { FrameLayer, LayerName, LevelName } from "../../client/codec/layers";
import type { RoomWish } from "../../client/rest/rooms";
import type { Connection } from "../../client/session/connection";
import type { ConnectionEvent, Identity, LinkStats as ConnectionStats } from "../../client/session/events";

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
export interface LinkStats extends ConnectionStats {
  /** Finest level at which surface and particles are sent now, and what limits it. */
  level: LevelName;
  levelLimitedBy: "none" | "choice" | "link" | "device";
}

/** What the connection reports besides frames. */
export type PageConnectionEvent = Exclude<ConnectionEvent, { kind: "stats" }> | { kind: "stats"; stats: LinkStats };

export type PageEvent =
  | Exclude<PageConnectionEvent, { kind: "stats" }>
  | { kind: "frame"; frame: Frame }
  /** `supersededCount`: frames dropped for newer ones because the page was busy. */
  | { kind: "stats"; stats: LinkStats; supersededCount: number };

/** What the worker says to a request for the ground: the ground, or the reason why it cannot be had, for people. */
export type GroundAnswer = { kind: "ground"; requestId: number } & ({ ground: GroundGrid } | { why: string });

/** One handler per event; a missing one does not compile. */
export type PageEventHandlers = { [K in PageEvent["kind"]]: (event: Extract<PageEvent, { kind: K }>) => void };

/** What follows from what the page shows. */
export interface PageWishes {
  detail: DetailChoice;
  /** Particles in the plain packing: finer velocities and densities, and more bytes. */
  exactParticles: boolean;
  /** The layers that the page shows, of those that the room has. */
  layers: readonly LayerName[];
  /** Frames of each layer per second, at most. */
  frameRateHz: number;
  /** A hidden page gets no frames; showing it again subscribes to them again. */
  visible: boolean;
}

/** The methods of the session that the page calls. */
export type SessionCalls = Pick<Connection, "introduce" | "command" | "retryNow">;

type Call = { [K in keyof SessionCalls]: { kind: "call"; name: K; args: Parameters<SessionCalls[K]> } }[keyof SessionCalls];

export type WorkerRequest =
  | Call
  | { kind: "want"; wishes: Partial<PageWishes> }
  /** `language`: of the connection's lines for people. */
  | { kind: "start"; url: string; identity: Identity; wish: RoomWish | undefined; language: string }
  | { kind: "ground"; requestId: number; address: string; room: string; token: string }
  | { kind: "release"; layer: FrameLayer; buffer: ArrayBuffer };

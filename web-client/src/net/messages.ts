// Messages between the page and the worker. The server's messages pass as client/codec/parse.ts declares them; calls to the connection
// pass as ConnectionCalls declares them. Frames travel as transferred ArrayBuffers: the page returns every one with
// "release", which bounds the frames on their way.
import type { FrameHeaders } from "../../client/codec/frame_types";
import type { GroundGrid } from "../../client/codec/ground";
import type { FrameLayer, LayerName, LevelName } from "../../client/codec/layers";
import type { RoomWish } from "../../client/rest/rooms";
import type { CommandAction, ConnectionEvent, Identity, LinkStats as ConnectionStats } from "../../client/session/events";

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

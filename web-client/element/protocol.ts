// What the page of `?embed` and the page around it say to each other by postMessage, version 1: plain objects with `spindrift: 1` and a
// `kind`. Both sides take messages only from the window and the origin that they expect, and read them with the functions below.
// docs/embedding.md describes the order.

/** Raised when a message changes its meaning. Messages of other versions are ignored. */
export const kProtocolVersion = 1;
/** Longest text in a message; longer ones make it invalid. */
export const kTextMaxLength = 200;
/** As the scene's largest sides: no coordinate or size of a command is larger. */
const kLargestM = 1e4;
const kMostTicks = 600;

/** A splash at a point of the water, metres from its middle: x to the right, z toward the first view. */
export interface SplashOptions {
  xM: number;
  zM: number;
  /** Radius of the disc that is pushed down; by default what suits the water, as for `depthM`. */
  radiusM?: number;
  depthM?: number;
}

/** A breaking wave; what is left out is what suits the water. */
export interface WaveOptions {
  amplitudeM?: number;
  lengthM?: number;
  /** Toward which it travels: 0 is +x, 90 is +z. By default it comes from the deepest side. */
  directionDeg?: number;
}

/** What the page around may ask for; the room decides by the visitor's role. */
export type Request =
  | ({ kind: "splash" } & SplashOptions)
  | ({ kind: "wave" } & WaveOptions)
  | { kind: "pause"; paused: boolean }
  | { kind: "step"; ticks: number }
  | { kind: "set"; path: string; value: number };

/** "hello" is the answer to "loaded"; a request has an id, which its answer repeats. */
export type ParentMessage = { kind: "hello" } | (Request & { id: number });

export type Role = "viewer" | "player" | "operator";

/** Events of the page of `?embed`, by kind. */
export interface FrameEvents {
  /** The page takes requests from now on. */
  ready: object;
  /** The room's water is there; again when room, scene or role change. */
  connected: { room: string; scene: string; title: string; role: Role };
  disconnected: { why: string };
  /** At most four per second: the newest state of the water. */
  frame: { timeS: number; tick: number };
  people: { count: number };
  /** A message was ignored, or the page cannot show water. */
  error: { message: string };
}

type FrameEvent = { [K in keyof FrameEvents]: { kind: K } & FrameEvents[K] }[keyof FrameEvents];

/** "loaded" has no data and goes to any parent: the page does not know yet who it is. */
export type FrameMessage = { kind: "loaded" } | FrameEvent | { kind: "done"; id: number; tick: number } | { kind: "refused"; id: number; reason: string };

/** Returns what is sent. */
export function envelope<M extends ParentMessage | FrameMessage>(message: M): M & { spindrift: number } {
  return { spindrift: kProtocolVersion, ...message };
}

/** Returns whether this is meant to be a message of this protocol; others are not worth a warning. */
export function isOurs(data: unknown): boolean {
  return typeof data === "object" && data !== null && "spindrift" in data;
}

type Read = (value: unknown) => boolean;
type Fields = Record<string, Read | [Read]>;

const isNumber = (value: unknown): value is number => typeof value === "number" && Number.isFinite(value);
const metres: Read = (value) => isNumber(value) && Math.abs(value) <= kLargestM;
const count: Read = (value) => Number.isSafeInteger(value) && (value as number) >= 0;
const text: Read = (value) => typeof value === "string" && value.length <= kTextMaxLength;
const role: Read = (value) => value === "viewer" || value === "player" || value === "operator";
const truth: Read = (value) => typeof value === "boolean";

/** Fields by kind; one in brackets may be left out. Others are dropped. */
const kParentFields: Record<ParentMessage["kind"], Fields> = {
  hello: {},
  splash: { id: count, xM: metres, zM: metres, radiusM: [metres], depthM: [metres] },
  wave: { id: count, amplitudeM: [metres], lengthM: [metres], directionDeg: [(value) => isNumber(value) && Math.abs(value) <= 360] },
  pause: { id: count, paused: truth },
  step: { id: count, ticks: (value) => count(value) && (value as number) >= 1 && (value as number) <= kMostTicks },
  set: { id: count, path: text, value: isNumber },
};

const kFrameFields: Record<FrameMessage["kind"], Fields> = {
  loaded: {},
  ready: {},
  connected: { room: text, scene: text, title: text, role },
  disconnected: { why: text },
  frame: { timeS: isNumber, tick: count },
  people: { count },
  error: { message: text },
  done: { id: count, tick: count },
  refused: { id: count, reason: text },
};

/** Returns a message of the page around, or why it is invalid. Never throws. */
export function readParentMessage(data: unknown): ParentMessage | string {
  return read<ParentMessage>(data, kParentFields);
}

/** Returns a message of the page of `?embed`, or why it is invalid. Never throws. */
export function readFrameMessage(data: unknown): FrameMessage | string {
  return read<FrameMessage>(data, kFrameFields);
}

function read<M extends { kind: string }>(data: unknown, kinds: Record<M["kind"], Fields>): M | string {
  if (!isOurs(data)) return "not a message of Spindrift";
  const given = data as Record<string, unknown>;
  if (given["spindrift"] !== kProtocolVersion) return `version ${shown(given["spindrift"])} of the messages; this page has ${kProtocolVersion}`;
  const kind = given["kind"];
  if (typeof kind !== "string" || !Object.hasOwn(kinds, kind)) return `kind ${shown(kind)} is unknown; use ${Object.keys(kinds).join(", ")}`;
  const message: Record<string, unknown> = { kind };
  for (const [name, rule] of Object.entries<Read | [Read]>(kinds[kind as M["kind"]])) {
    const value = given[name];
    if (Array.isArray(rule) && value === undefined) continue;
    if (!(Array.isArray(rule) ? rule[0] : rule)(value)) return `${kind}: ${name} ${shown(value)} is missing, of another type or out of range`;
    message[name] = value;
  }
  return message as M;
}

/** Of an untrusted value, for one line. */
function shown(value: unknown): string {
  if (typeof value === "object" || typeof value === "function") return value === null ? "null" : `(${typeof value})`;
  return `"${clipped(String(value), 40)}"`;
}

/** Cuts a text to the length that a message may have. */
export function clipped(value: string, length = kTextMaxLength): string {
  return value.length > length ? `${value.slice(0, length - 1)}…` : value;
}

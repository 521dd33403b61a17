// Bytes of one WebSocket message → one member of a discriminated union. Pure: no state, no exception. Bytes that cannot be trusted
// give "malformed" with the reason. Payloads are views into the message, not copies.
//
// kReaders is the one place that declares a server message: the union of messages, the events of the connection and of the page's worker
// follow from it.
import { fromBinary } from "@bufbuild/protobuf";

import { RejectReason, RoomEventKind, ServerMessageSchema, type Diagnostics, type Draining, type ServerMessage } from "../gen/spindrift/v1/wire_pb";
import type { PackedFrame, PlainFrame } from "./frame_types";
import { readGame } from "./game";
import { readBoatList, readGreeting } from "./greeting";
import { levelName } from "./layers";
import { readHullForces } from "./hulls";
import { readLesson } from "./lesson";
import { isMalformed, malformed, type Malformed } from "./malformed";
import { parseFrame } from "./parse_frame";
import { readPeople, readWelcome } from "./people";
import { readQueryAnswer } from "./query";
import { isPlace, kMaxGaugeCount } from "./scene_info";
import { readStrokes } from "./strokes";

type WireMessage = Exclude<ServerMessage["message"], { case: undefined }>;
/** Frames have parseFrame(). */
type Kind = Exclude<WireMessage["case"], "frame">;
type ReaderOf<K extends Kind> = (value: Extract<WireMessage, { case: K }>["value"]) => object;

/** Each returns plain data that survives postMessage, or why it cannot be trusted. */
const kReaders = {
  greeting: (greeting) => readGreeting(greeting),
  diagnostics: (diagnostics) => ({ diagnostics: readDiagnostics(diagnostics) }),
  ack: ({ commandId, appliedTick, boatId, floaterId, gaugeId, stateHash }) => ({ commandId, appliedTick, boatId, floaterId, gaugeId, stateHash }),
  reject: ({ commandId, reason, field, message }) => ({ commandId, reason: RejectReason[reason] ?? `${reason}`, field, message }),
  parameterChanged: ({ path, value, appliedTick }) =>
    Number.isFinite(value) ? { path, value, appliedTick } : malformed(`parameter ${path} is ${value}`),
  roomState: ({ paused, speed, personId, clockPersonIds }) => ({ paused, speed, personId, clockPersonIds }),
  boatList: (list) => {
    const boats = readBoatList(list);
    return typeof boats === "string" ? malformed(boats) : { boats };
  },
  roomEvent: ({ kind, tick, message, personId }) => ({ event: roomEventName(kind), tick, message, personId }),
  welcome: (welcome) => ({ welcome: readWelcome(welcome) }),
  people: (people) => ({ people: readPeople(people), unlistedCount: people.unlistedCount }),
  strokes: (strokes) => readStrokes(strokes),
  lesson: (lesson) => readLesson(lesson),
  game: (game) => readGame(game),
  queryAnswer: (answer) => readQueryAnswer(answer),
  hullForces: (forces) => readHullForces(forces),
  levelChanged: ({ level }) => ({ level: levelName(level) }),
  draining: (draining) => readDraining(draining),
  pong: ({ clientTimeS, serverTimeS }) => ({ clientTimeS, serverTimeS }),
  refusal: ({ message }) => ({ message }),
} satisfies { [K in Kind]: ReaderOf<K> };

/** A message of the server as read, frames apart. */
type ParsedEvent = { [K in Kind]: { kind: K } & Exclude<ReturnType<(typeof kReaders)[K]>, Malformed> }[Kind];

export type ParsedMessage = ParsedEvent | PlainFrame | PackedFrame | { kind: "unknown" } | Malformed;

/** Reads one binary message. Never throws. */
export function parse(buffer: ArrayBuffer): ParsedMessage {
  try {
    const { message } = fromBinary(ServerMessageSchema, new Uint8Array(buffer));
    // A message that only a newer server knows, or an empty one: the wire says to ignore it.
    if (message.case === undefined) return { kind: "unknown" };
    if (message.case === "frame") return parseFrame(message.value);
    const read = (kReaders[message.case] as (value: unknown) => object)(message.value);
    return isMalformed(read) ? read : ({ kind: message.case, ...read } as ParsedEvent);
  } catch (error) {
    return malformed(error instanceof Error ? error.message : String(error));
  }
}

export type DiagnosticsInfo = ReturnType<typeof readDiagnostics>;

function readDiagnostics({ $typeName: _, $unknown: __, passes, gauges, ...numbers }: Diagnostics) {
  return {
    ...numbers,
    passes: passes.map(({ name, ms }) => ({ name, ms })),
    gauges: gauges
      .slice(0, kMaxGaugeCount)
      .filter(({ xM, zM }) => isPlace(xM) && isPlace(zM))
      .map(({ $typeName: _type, $unknown: _unknown, ...gauge }) => gauge),
  };
}

function roomEventName(kind: RoomEventKind): "recovered" | "reset" | "fidelity" | "clock" | "other" {
  if (kind === RoomEventKind.RECOVERED) return "recovered";
  if (kind === RoomEventKind.FIDELITY) return "fidelity";
  if (kind === RoomEventKind.CLOCK) return "clock";
  return kind === RoomEventKind.RESET ? "reset" : "other";
}

/** The server is about to end. `goTo`: ws://HOST or wss://HOST; empty: the same server. */
export type DrainingInfo = Pick<Draining, "closesInS" | "goTo" | "reconnectAfterMinS" | "reconnectAfterMaxS">;

function readDraining({ closesInS, goTo, reconnectAfterMinS, reconnectAfterMaxS }: Draining): { draining: DrainingInfo } | Malformed {
  if (![closesInS, reconnectAfterMinS, reconnectAfterMaxS].every((value) => Number.isFinite(value) && value >= 0) || reconnectAfterMaxS < reconnectAfterMinS)
    return malformed(`draining: times ${closesInS}, ${reconnectAfterMinS} and ${reconnectAfterMaxS} s`);
  if (goTo !== "" && !/^wss?:\/\/[^/?#@]+\/?$/.test(goTo)) return malformed(`draining: ${goTo} is not an address of a server`);
  return { draining: { closesInS, goTo, reconnectAfterMinS, reconnectAfterMaxS } };
}

// Bytes of one WebSocket message → one member of a discriminated union. Pure: no state, no exception; what cannot be
// trusted comes back as "malformed" with the reason. Payloads are views into the message, not copies.
import { fromBinary } from "@bufbuild/protobuf";

import { RejectReason, RoomEventKind, ServerMessageSchema } from "../gen/spindrift/v1/wire_pb";
import { parseFrame, type ParsedFrame } from "./frames";
import { readBoatList, readGreeting, type BoatDetail, type GreetingInfo } from "./greeting";
import { levelName, type LevelName } from "./level";
import { malformed, type Malformed } from "./malformed";
import { readPeople, readWelcome, type PersonInfo, type WelcomeInfo } from "./people";
import type { PackedFoam, PackedSurface } from "./packed_planes";

export interface DiagnosticsInfo {
  tick: bigint;
  timeS: number;
  stepMs: number;
  realTimeFactor: number;
  substepsCount: number;
  particleCount: number;
  maxParticleSpeedMps: number;
  maxElevationM: number;
  meanDensityRatio: number;
  maxDensityRatio: number;
  kineticEnergyJ: number;
  potentialEnergyJ: number;
  waveEnergyJ: number;
  nonfiniteCount: bigint;
  escapedCount: bigint;
  recoveredCount: bigint;
  passes: { name: string; ms: number }[];
  boatCount: number;
  /** Of the volume ledger, in its own units; 0 in a healthy room. */
  volumeErrorUnits: bigint;
  emittedM3: number;
  absorbedM3: number;
  breakingRatio: number;
  /** As FrameHeader.stateId. */
  stateId: bigint;
}

export type RoomEventName = "recovered" | "reset" | "other";

export type ParsedMessage =
  | { kind: "greeting"; greeting: GreetingInfo }
  | ParsedFrame
  | PackedSurface
  | PackedFoam
  | { kind: "diagnostics"; diagnostics: DiagnosticsInfo }
  | { kind: "ack"; commandId: bigint; appliedTick: bigint; boatId: number }
  | { kind: "reject"; commandId: bigint; reason: string; field: string; message: string }
  | { kind: "parameterChanged"; path: string; value: number; appliedTick: bigint }
  | { kind: "roomState"; paused: boolean; speed: number }
  | { kind: "boatList"; boats: BoatDetail[] }
  | { kind: "roomEvent"; event: RoomEventName; tick: bigint; message: string }
  | { kind: "welcome"; welcome: WelcomeInfo }
  | { kind: "people"; people: PersonInfo[] }
  | { kind: "levelChanged"; level: LevelName }
  | { kind: "pong"; clientTimeS: number; serverTimeS: number }
  | { kind: "refusal"; message: string }
  | { kind: "unknown" }
  | Malformed;

function roomEventName(kind: RoomEventKind): RoomEventName {
  if (kind === RoomEventKind.RECOVERED) return "recovered";
  return kind === RoomEventKind.RESET ? "reset" : "other";
}

/** Reads one binary message. Never throws. */
export function parse(buffer: ArrayBuffer): ParsedMessage {
  try {
    const { message } = fromBinary(ServerMessageSchema, new Uint8Array(buffer));
    switch (message.case) {
      case "greeting":
        return readGreeting(message.value);
      case "frame":
        return parseFrame(message.value);
      case "diagnostics": {
        const { $typeName: _, $unknown: __, passes, ...numbers } = message.value;
        return { kind: "diagnostics", diagnostics: { ...numbers, passes: passes.map(({ name, ms }) => ({ name, ms })) } };
      }
      case "ack": {
        const { commandId, appliedTick, boatId } = message.value;
        return { kind: "ack", commandId, appliedTick, boatId };
      }
      case "reject": {
        const { commandId, reason, field, message: text } = message.value;
        return { kind: "reject", commandId, reason: RejectReason[reason] ?? `${reason}`, field, message: text };
      }
      case "parameterChanged": {
        const { path, value, appliedTick } = message.value;
        if (!Number.isFinite(value)) return malformed(`parameter ${path} is ${value}`);
        return { kind: "parameterChanged", path, value, appliedTick };
      }
      case "roomState":
        return { kind: "roomState", paused: message.value.paused, speed: message.value.speed };
      case "boatList": {
        const boats = readBoatList(message.value);
        return typeof boats === "string" ? malformed(boats) : { kind: "boatList", boats };
      }
      case "roomEvent": {
        const { kind, tick, message: text } = message.value;
        return { kind: "roomEvent", event: roomEventName(kind), tick, message: text };
      }
      case "welcome":
        return { kind: "welcome", welcome: readWelcome(message.value) };
      case "people":
        return { kind: "people", people: readPeople(message.value) };
      case "levelChanged":
        return { kind: "levelChanged", level: levelName(message.value.level) };
      case "pong":
        return { kind: "pong", clientTimeS: message.value.clientTimeS, serverTimeS: message.value.serverTimeS };
      case "refusal":
        return { kind: "refusal", message: message.value.message };
      case undefined:
        // A kind that a newer server knows, or an empty message: the wire says to ignore it.
        return { kind: "unknown" };
    }
  } catch (error) {
    return malformed(error instanceof Error ? error.message : String(error));
  }
}

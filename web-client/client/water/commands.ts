// Commands by name: every action of Command in wire.proto is a method that takes the fields of its message.
import { getOption, hasOption, ScalarType, type DescField, type DescMessage } from "@bufbuild/protobuf";

import type { ParameterInfo } from "../codec/greeting";
import { parameter } from "../gen/spindrift/v1/options_pb";
import { CommandSchema, RejectReason } from "../gen/spindrift/v1/wire_pb";
import type { CommandAction, ConnectionEvent } from "../session/events";
import { ConnectionLost, NoAnswer, Rejected, SpindriftError, type Bound, type RejectReasonName } from "./errors";

/** The server's answer to a command that it carried out. */
export interface Ack {
  /** The first tick that shows it. */
  appliedTick: number;
  /** Of spawnBoat, spawnFloater and placeGauge: the new one; 0 of others. */
  boatId: number;
  floaterId: number;
  gaugeId: number;
  /** Of a step that waits: of the state after appliedTick. */
  stateHash: bigint | undefined;
}

/** The answer to a query is another message than its Ack: Water.query. */
type CommandName = Exclude<CommandAction["case"], "query">;

/** 64-bit numbers may be given as a number or a bigint. */
type Wide<V> = { [P in keyof V]: bigint extends V[P] ? V[P] | number : V[P] };
type Fields<K extends CommandAction["case"]> = Wide<Extract<CommandAction, { case: K }>["value"]>;

/** Each sends its command. The promise is resolved when the server has carried it out, and rejected with Rejected, ConnectionLost or
 *  NoAnswer; fields that the command does not have are a TypeError. Units and bounds stand at the fields. */
export type Commands = { [K in CommandName]: (fields?: Fields<K>) => Promise<Ack> };

/** The commands, by name. */
export const kActions: ReadonlyMap<string, DescField> = new Map(CommandSchema.oneofs[0]!.fields.filter(({ localName }) => localName !== "query").map((field) => [field.localName, field]));

/** Names of all commands. */
export const kCommandNames = [...kActions.keys()] as CommandName[];

/** Throws a TypeError for a command or a field that there is not. */
export function checkFields(name: string, fields: unknown): void {
  const message = kActions.get(name)?.message;
  if (!message) throw new TypeError(`there is no command ${JSON.stringify(name)}; there are ${kCommandNames.join(", ")}`);
  checkMessage(message, fields, name);
}

function checkMessage(message: DescMessage, value: unknown, path: string): void {
  if (typeof value !== "object" || value === null) throw new TypeError(`${path} takes an object with its fields, not ${String(value)}`);
  for (const [name, each] of Object.entries(value)) {
    if (name.startsWith("$") || each === undefined) continue;
    const field = message.fields.find(({ localName }) => localName === name);
    if (!field) throw new TypeError(`${path} has no ${JSON.stringify(name)}; it has ${message.fields.map(({ localName }) => localName).join(", ") || "no fields"}`);
    if (field.fieldKind === "message") checkMessage(field.message, each, `${path}.${name}`);
    else if (field.fieldKind === "list" && !Array.isArray(each)) throw new TypeError(`${path}.${name} takes an array, not ${String(each)}`);
    else if (field.fieldKind === "list" && field.listKind === "message") (each as unknown[]).forEach((one, k) => checkMessage(field.message, one, `${path}.${name}[${k}]`));
    else if (field.fieldKind === "scalar" && typeof each !== typeOf(field.scalar) && !(is64Bits(field.scalar) && typeof each === "bigint")) throw new TypeError(`${path}.${name} takes a ${typeOf(field.scalar)}, not ${String(each)}`);
  }
}

function is64Bits(scalar: ScalarType): boolean {
  return scalar === ScalarType.UINT64 || scalar === ScalarType.FIXED64;
}

/** Commands have no bytes. */
function typeOf(scalar: ScalarType): "boolean" | "string" | "number" {
  return scalar === ScalarType.BOOL ? "boolean" : scalar === ScalarType.STRING ? "string" : "number";
}

/** Returns what `action` holds in the field that a Reject names, and what the wire allows there; of a parameter, what its description says. */
export function offence({ case: name, value: fields }: CommandAction, field: string, parameters: ReadonlyMap<string, ParameterInfo>): { value: unknown; bound: Bound | undefined } {
  if (name === "setParameter") {
    const described = parameters.get(field);
    return { value: fields.value, bound: described && boundOf(described) };
  }
  const [head, ...path] = field.split(".");
  const action = CommandSchema.field[name]!;
  if (head !== action.name) return { value: undefined, bound: undefined };
  let message = action.message;
  let value: unknown = fields;
  let bound: Bound | undefined;
  for (const step of path) {
    const [, protoName, index] = /^(\w+)(?:\[(\d+)\])?$/.exec(step) ?? [];
    const at = message?.fields.find((each) => each.name === protoName);
    if (!at) return { value: undefined, bound: undefined };
    value = (value as Record<string, unknown> | undefined)?.[at.localName];
    if (index !== undefined) value = (value as unknown[] | undefined)?.[Number(index)];
    if (hasOption(at, parameter)) bound = boundOf(getOption(at, parameter));
    message = at.message;
  }
  return { value, bound };
}

/** Why a command was not carried out, or may not have been. `live`: whether commands can be sent at present. */
export function errorOf({ reason, field, message }: Extract<ConnectionEvent, { kind: "reject" }>, action: CommandAction, parameters: ReadonlyMap<string, ParameterInfo>, live: boolean): SpindriftError {
  const name = action.case;
  if (reason === "LOST") return new ConnectionLost(`${message}; ${name} may or may not have been carried out`, true);
  if (reason === "NO_ANSWER") return new NoAnswer(`${message} to ${name}; it may still be carried out`);
  if (reason === "NOT_SENT") return live ? new SpindriftError(`${name} was not sent: ${message}`) : new ConnectionLost(`${name} was not sent: ${message}`);
  const { value, bound } = offence(action, field, parameters);
  return new Rejected(message, reason in RejectReason && !/^\d/.test(reason) ? (reason as RejectReasonName) : "OTHER", field, value, bound);
}

function boundOf({ min, max, unit }: Bound): Bound {
  return { min, max, unit };
}

// Commands as an agent reads and writes them: a list in words, and fields as JSON.
import { fromJson, getOption, hasOption, type DescField, type DescMessage, type JsonValue } from "@bufbuild/protobuf";

import { parameter } from "../gen/spindrift/v1/options_pb";
import { checkFields, kActions, kCommandNames } from "../water/commands";

/** Names of all commands. */
export const kCommands = kCommandNames as [string, ...string[]];

/** A line for each command and, indented, for each of its fields: type or unit and bounds, and what it is if left out. */
export function describeCommands(): string {
  return [...kActions.values()].map((action) => [action.localName, ...linesOf(action.message!, "  ")].join("\n")).join("\n");
}

function linesOf(message: DescMessage, indent: string): string[] {
  return message.fields.flatMap((field) => [`${indent}${field.localName}: ${typeOf(field)}`, ...(field.message ? linesOf(field.message, `${indent}  `) : [])]);
}

function typeOf(field: DescField): string {
  const list = field.fieldKind === "list" ? "a list of " : "";
  if (field.enum) return `${list}${field.enum.values.map(({ name }) => name).join(", ")}`;
  if (field.message) return list ? "a list of objects" : "an object";
  if (!hasOption(field, parameter)) return `${list}${field.fieldKind === "scalar" ? { 8: "true or false", 9: "a text" }[field.scalar as number] ?? "a number" : "values"}`;
  const { label, min, max, unit, default: fallback, help } = getOption(field, parameter);
  return `${label}, ${min} to ${max}${unit && ` ${unit}`}; ${fallback} or what suits the water if left out${help && `. ${help}`}`;
}

/** Returns the fields of a command from JSON, in which enums are names. Throws a TypeError that lists the fields that there are. */
export function fieldsOf(command: string, json: Record<string, unknown>): object {
  checkFields(command, json);
  try {
    return fromJson(kActions.get(command)!.message!, json as JsonValue);
  } catch (error) {
    throw new TypeError(`${command}: ${error instanceof Error ? error.message : String(error)}`);
  }
}

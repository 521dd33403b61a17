// The fidelity levels of the simulation by name, with what the server says of them.
import { Fidelity } from "../gen/spindrift/v1/scene_pb";
import type { FidelityLevels } from "../gen/spindrift/v1/wire_pb";

/** Coarsest first. */
export const kFidelities = [
  { name: "draft", wire: Fidelity.DRAFT },
  { name: "balanced", wire: Fidelity.BALANCED },
  { name: "fine", wire: Fidelity.FINE },
  { name: "reference", wire: Fidelity.REFERENCE },
] as const;

export type FidelityName = (typeof kFidelities)[number]["name"];

/** Returns "balanced" for a value that this client does not know, as the server does for a scene that names none. */
export function fidelityName(wire: Fidelity | undefined): FidelityName {
  return kFidelities.find((level) => level.wire === wire)?.name ?? "balanced";
}

export function wireFidelity(name: FidelityName): Fidelity {
  return kFidelities.find((level) => level.name === name)!.wire;
}

/** A level that the room's scene can take. */
export interface FidelityLevelInfo {
  name: FidelityName;
  /** Time that a simulated second takes the server, milliseconds: measured at the present level, predicted at the others. */
  costMsPerS: number;
  /** Error of the water's height over that height; undefined where it was not measured. */
  errorRatio: number | undefined;
  /** Day (UTC) of that measurement. */
  measuredOn: string;
}

/** Returns the known levels with a usable cost, in the order of kFidelities; none from a server that does not send them. */
export function readFidelityLevels(message: FidelityLevels | undefined): FidelityLevelInfo[] {
  const isFigure = (value: number | undefined): value is number => value !== undefined && value >= 0 && Number.isFinite(value);
  return kFidelities.flatMap(({ name, wire }) => {
    const level = message?.levels.find(({ fidelity }) => fidelity === wire);
    if (!isFigure(level?.costMsPerS)) return [];
    const errorRatio = isFigure(level.errorRatio) ? level.errorRatio : undefined;
    return [{ name, costMsPerS: level.costMsPerS, errorRatio, measuredOn: message!.errorsMeasuredOn }];
  });
}

// The fidelity levels of the simulation by name.
import { Fidelity } from "../gen/spindrift/v1/scene_pb";

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

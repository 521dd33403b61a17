// What the water does to boats that this client moves.
import type { HullForces, Wrench } from "../gen/spindrift/v1/wire_pb";
import { malformed, type Malformed } from "./malformed";

/** A force in the axes of the water, and its moment about the hull's centre in the axes of the hull. */
export interface WrenchInfo {
  forceXN: number;
  forceYN: number;
  forceZN: number;
  /** Positive lowers starboard. */
  momentRollNm: number;
  /** Positive lifts the bow. */
  momentPitchNm: number;
  /** Positive turns from +x toward +z. */
  momentYawNm: number;
}

/** What the water did to a hull in a tick, as a mean over it. Weight, thrust and the boat's mass are not in it. */
export interface HullForceInfo {
  boatId: number;
  /** Buoyancy of the submerged hull under the still surface around it. */
  hydrostatic: WrenchInfo;
  /** Pressure of waves, the dent of the hull itself included. */
  dynamic: WrenchInfo;
  /** Resistance against the moving water. */
  drag: WrenchInfo;
}

export interface HullForcesInfo {
  tick: number;
  /** Simulation time since the scene began or was reset. */
  timeS: number;
  /** As of frames: those with the same number show the same water. */
  stateId: number;
  hulls: HullForceInfo[];
}

function wrenchOf(wrench: Wrench | undefined): WrenchInfo {
  const { forceXN = 0, forceYN = 0, forceZN = 0, momentRollNm = 0, momentPitchNm = 0, momentYawNm = 0 } = wrench ?? {};
  return { forceXN, forceYN, forceZN, momentRollNm, momentPitchNm, momentYawNm };
}

export function readHullForces({ tick, timeS, stateId, hulls }: HullForces): HullForcesInfo | Malformed {
  const read = hulls.map(({ boatId, hydrostatic, dynamic, drag }) => ({ boatId, hydrostatic: wrenchOf(hydrostatic), dynamic: wrenchOf(dynamic), drag: wrenchOf(drag) }));
  for (const { boatId, ...parts } of read)
    for (const part of Object.values(parts)) if (!Object.values(part).every(Number.isFinite)) return malformed(`forces on boat ${boatId} are not finite`);
  return { tick: Number(tick), timeS, stateId: Number(stateId), hulls: read };
}

// Navigation lights: which of them are seen from where (International Regulations for Preventing Collisions at Sea, rules 21 and 23).
import { Vector3, type Object3D } from "three";

import type { BoatDetail } from "../../../client/codec/greeting";
import { kLampColors, type LampColor, type Lamps } from "../light/lamps";
import { clamp } from "../maths/interpolate";
import type { BoatLamp } from "./fittings";

/** Side lights and the masthead light end this far from straight ahead, and the stern light begins. */
const kAbaftBeamDeg = 112.5;
/** A sector's edge is soft over this angle. */
const kEdgeDeg = 4;
/** Radius of the glow, in boat lengths. */
const kGlowLengths = 0.14;

const kColors: Record<BoatLamp["kind"], LampColor> = {
  port: kLampColors.red,
  starboard: kLampColors.green,
  masthead: kLampColors.white,
  stern: kLampColors.white,
  allRound: kLampColors.white,
};

/** Returns the share of a light that is seen at a bearing from the bow, positive to starboard. */
export function lampShare(kind: BoatLamp["kind"], bearingDeg: number): number {
  const soft = (insideDeg: number): number => clamp(0.5 + insideDeg / kEdgeDeg, 0, 1);
  const ahead = soft(kAbaftBeamDeg - Math.abs(bearingDeg));
  if (kind === "allRound") return 1;
  if (kind === "masthead") return ahead;
  if (kind === "stern") return 1 - ahead;
  return ahead * soft(kind === "starboard" ? bearingDeg : -bearingDeg);
}

const scratchM = new Vector3();

/** Adds the lights of one boat, which `placed` has moved to its position. */
export function addBoatLamps(lamps: Lamps, boat: BoatDetail, placed: Object3D, own: readonly BoatLamp[], cameraM: Vector3): void {
  const seen = placed.worldToLocal(scratchM.copy(cameraM));
  const bearingDeg = (Math.atan2(seen.z, seen.x) * 180) / Math.PI;
  for (const { at, kind } of own) {
    const { x, y, z } = placed.localToWorld(scratchM.set(...at));
    lamps.add(x, y, z, kGlowLengths * boat.lengthM, kColors[kind], lampShare(kind, bearingDeg));
  }
}

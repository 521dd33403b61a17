// The records of a bodies frame.
import { kBodyBytes } from "./frame_types";

/** A boat: coordinates of the middle between keel and deck; y points up, 0 is the water at rest. */
export interface BodyPose {
  boatId: number;
  xM: number;
  yM: number;
  zM: number;
  /** From +x toward +z. */
  headingRad: number;
  /** Positive lifts the bow. */
  pitchRad: number;
  /** Positive lowers starboard. */
  rollRad: number;
  speedMps: number;
  throttle: number;
  rudder: number;
}

/** Reads `count` records from the beginning of the view. */
export function readBodies(view: DataView, count: number): BodyPose[] {
  const angle = (at: number): number => (view.getInt16(at, true) / 32767) * Math.PI;
  const bodies: BodyPose[] = [];
  for (let at = 0; at < count * kBodyBytes; at += kBodyBytes)
    bodies.push({
      boatId: view.getUint32(at, true),
      xM: view.getInt32(at + 4, true) / 1000,
      yM: view.getInt32(at + 8, true) / 1000,
      zM: view.getInt32(at + 12, true) / 1000,
      headingRad: angle(at + 16),
      pitchRad: angle(at + 18),
      rollRad: angle(at + 20),
      speedMps: view.getInt16(at + 22, true) / 100,
      throttle: view.getInt8(at + 24) / 127,
      rudder: view.getInt8(at + 25) / 127,
    });
  return bodies;
}

// The wave tone: the elevation of the water at one place as the pitch of a note. Pure.
import { clamp } from "../scene/maths/interpolate";

/** Concert pitch: water at its rest level. */
export const kRestHz = 440;
/** Pitches reach from an octave below to an octave above. */
const kOctaves = 1;
/** Elevations that make an octave [m]. */
export const kOctavesM = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2] as const;
const kDefaultDepths = 0.15;

/** Returns the pitch of an elevation; `octaveM` up is an octave higher. Beyond an octave it stays. */
export function pitchHz(elevationM: number, octaveM: number): number {
  return kRestHz * 2 ** clamp(elevationM / octaveM, -kOctaves, kOctaves);
}

/** Returns the elevation for an octave that suits a depth. */
export function octaveForDepthM(depthM: number): number {
  return kOctavesM.findLast((octaveM) => octaveM <= kDefaultDepths * depthM) ?? kOctavesM[0];
}

// Ripples: waves too short for the simulation's grid, as the second cascade of the open sea. They change the normals only, inside and
// outside the simulated square alike. Pure.
import type { WindInfo } from "../../../client/codec/scene_info";
import { clamp, smoothstep } from "../maths/interpolate";
import { makeRandom, type PlaneWave } from "./sea_state";

/** Surface tension over density, m^3/s^2. */
const kSurfaceTension = 7.3e-5;
const kSpreadRad = 1.25;
/** Root mean square slope in a light breeze of 4 m/s, which blows without a storm, too, and what a full storm adds: three quarters of the
 * slopes that Cox & Munk (1954) give for 15 m/s, the rest is in the longer waves. */
const kCalmSlope = 0.15;
const kStormSlope = 0.09;
/** Where a storm brings rain without wind, so that one sees the rings. */
const kWindlessSlope = 0.012;

/** Returns the root mean square slope of the ripples; without a storm there is a little wind. */
export function rippleSlope(wind: Pick<WindInfo, "levelRatio" | "waveHeightM"> | undefined): number {
  if (!wind) return kCalmSlope;
  return wind.waveHeightM === 0 ? kWindlessSlope : kCalmSlope + kStormSlope * clamp(wind.levelRatio, 0, 1);
}

/** Returns how many times as much crests seem to be curved where it is decided whether they foam, in the wind that raises ripples of this
 * slope: 1 without wind, 2 from a third of a storm on. */
export function tornByWind(slope: number): number {
  return 1 + smoothstep(kCalmSlope - 0.01, kCalmSlope + 0.35 * kStormSlope, slope);
}

/**
 * Returns `count` waves with lengths between the two given, spread about the wind's direction, whose slopes have the root mean square 1:
 * multiply the amplitudes by the slope wanted. Each carries the same share.
 */
export function makeRipples(count: number, shortestM: number, longestM: number, directionDeg: number, gravityMps2: number): PlaneWave[] {
  const random = makeRandom(7n);
  return Array.from({ length: count }, (_, n) => {
    const lengthM = longestM * (shortestM / longestM) ** ((n + random()) / count);
    const k = (2 * Math.PI) / lengthM;
    const angle = (directionDeg * Math.PI) / 180 + kSpreadRad * (2 * random() - 1);
    return {
      amplitudeM: Math.sqrt(2 / count) / k,
      omegaRadps: Math.sqrt(Math.max(gravityMps2, 0) * k + kSurfaceTension * k ** 3),
      kxRadpm: k * Math.cos(angle),
      kzRadpm: k * Math.sin(angle),
      phaseRad: 2 * Math.PI * random(),
    };
  });
}

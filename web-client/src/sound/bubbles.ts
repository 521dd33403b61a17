// How bubbles ring. Water that is hit encloses air, and the bubbles are what one hears of a drop or a splash. Pure.
import { clamp } from "../scene/maths/interpolate";

/** Frequency times radius of a bubble of air in water near the surface (Minnaert 1933: f = sqrt(3 gamma p / rho) / (2 pi r)). */
const kMinnaertHzM = 3.26;
/** Damping by heat and by radiation, 0.13 / r + 0.0072 / r^1.5 (van den Doel 2005, "Physically based models for liquid sounds", equation 4). */
const kHeat = 0.13;
const kRadiation = 0.0072;
/** Smaller and larger bubbles are heard badly. */
const kRadiiM = [0.0005, 0.04] as const;
/** Radius of the largest bubble under what falls into water, over the radius of that. */
const kBubblePerRadius = 0.25;

export function minnaertHz(radiusM: number): number {
  return kMinnaertHzM / radiusM;
}

/** Returns the rate at which a bubble's amplitude decays [1/s]. */
export function dampingPerS(radiusM: number): number {
  return kHeat / radiusM + kRadiation / radiusM ** 1.5;
}

/** Returns the radius of the largest bubble that is heard when something of `radiusM` falls into water. */
export function bubbleRadiusM(radiusM: number): number {
  return clamp(kBubblePerRadius * radiusM, ...kRadiiM);
}

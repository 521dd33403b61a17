// The colours of the ground, and those that water leaves on stone: dark weed from below the still water's level to a little above it,
// and a pale line of barnacles over the weed.
import { clamp, mix, ramp } from "../maths/interpolate";
import type { Paint } from "../meshes/mesh_builder";

const kSand: Paint = [0.66, 0.53, 0.36, 0.7];
/** Of the tiles of a tank, on its bed and its walls: dark enough for white water to stand out. */
export const kTankTile = [0.10, 0.30, 0.42] as const;
const kSeabed: Paint = [0.36, 0.33, 0.25, 0.9];
const kWeed = [0.075, 0.10, 0.045] as const;
const kBarnacles = [0.47, 0.46, 0.41] as const;

export function mixPaint(a: Paint, b: Paint, share: number): Paint {
  return [0, 1, 2, 3].map((c) => mix(a[c]!, b[c]!, share)) as unknown as Paint;
}

/** Returns the paint of the bed at a height over the still water: sand at a shore. */
export function bedPaint(yM: number, depthM: number): Paint {
  return mixPaint(kSeabed, kSand, clamp(1 + yM / (0.8 * depthM), 0, 1));
}

export function shaded([r, g, b, grain]: Paint, share: number): Paint {
  return [r * share, g * share, b * share, grain];
}

/** Returns the paint of stone at a height over the still water; weed grows up to about `weedM`. */
export function overgrown(stone: Paint, yM: number, weedM: number): Paint {
  const weed = ramp(-7 * weedM, -2 * weedM, yM) * (1 - ramp(0.5 * weedM, 1.2 * weedM, yM));
  const barnacles = ramp(0.8 * weedM, 1.2 * weedM, yM) * (1 - ramp(1.5 * weedM, 2.2 * weedM, yM));
  const grown = (paint: Paint, [r, g, b]: readonly [number, number, number], share: number): Paint => mixPaint(paint, [r, g, b, paint[3]], share);
  return grown(grown(stone, kWeed, 0.85 * weed), kBarnacles, 0.4 * barnacles);
}

// The colours that water leaves on stone: dark weed from below the still water's level to a little above it, and a pale line of
// barnacles over the weed.
import type { Paint } from "../meshes/mesh_builder";

const kWeed = [0.075, 0.10, 0.045] as const;
const kBarnacles = [0.47, 0.46, 0.41] as const;

export function shaded([r, g, b, grain]: Paint, share: number): Paint {
  return [r * share, g * share, b * share, grain];
}

function mixed([r, g, b, grain]: Paint, other: readonly [number, number, number], share: number): Paint {
  return [r + (other[0] - r) * share, g + (other[1] - g) * share, b + (other[2] - b) * share, grain];
}

const ramp = (from: number, to: number, at: number): number => Math.min(Math.max((at - from) / (to - from), 0), 1);

/** Returns the paint of stone at a height over the still water; weed grows up to about `weedM`. */
export function overgrown(stone: Paint, yM: number, weedM: number): Paint {
  const weed = ramp(-7 * weedM, -2 * weedM, yM) * (1 - ramp(0.5 * weedM, 1.2 * weedM, yM));
  const barnacles = ramp(0.8 * weedM, 1.2 * weedM, yM) * (1 - ramp(1.5 * weedM, 2.2 * weedM, yM));
  return mixed(mixed(stone, kWeed, 0.85 * weed), kBarnacles, 0.4 * barnacles);
}

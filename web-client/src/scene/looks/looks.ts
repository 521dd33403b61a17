// The looks of the water: its natural one, data in colours, and the plain one of the thesis. Which quantities they show, and which
// of them a room has data for. Pure.
import type { GreetingInfo } from "../../../client/codec/greeting";
import { kDensityRatios } from "../frames/particle_values";
import type { ColourMapName } from "./colour_map";

const kLookNames = ["natural", "height", "velocity", "breaking", "foam", "speed", "density", "thesis"] as const;
export type LookName = (typeof kLookNames)[number];

/** What a look shows in colours. */
export interface Quantity {
  look: LookName;
  unit: string;
  map: ColourMapName;
  /** Fixed bounds, or bounds that follow the values: signed ones around 0, others from 0 on. */
  range: { low: number; high: number; ticks?: number[] } | "signed" | "positive";
  /** Whose values: those of the surface or of single particles. */
  of: "surface" | "particles";
}

export interface Look {
  /** Undefined for looks without values. */
  quantity?: Quantity;
}

export const kLooks: Record<LookName, Look> = {
  natural: {},
  height: { quantity: { look: "height", unit: "m", map: "coolWarm", range: "signed", of: "surface" } },
  velocity: { quantity: { look: "velocity", unit: "m/s", map: "purpleGreen", range: "signed", of: "surface" } },
  breaking: { quantity: { look: "breaking", unit: "", map: "cividis", range: { low: 0, high: 1, ticks: [0, 0.15, 0.65, 1] }, of: "surface" } },
  foam: { quantity: { look: "foam", unit: "%", map: "cividis", range: { low: 0, high: 100 }, of: "surface" } },
  speed: { quantity: { look: "speed", unit: "m/s", map: "viridis", range: "positive", of: "particles" } },
  density: { quantity: { look: "density", unit: "", map: "viridis", range: kDensityRatios, of: "particles" } },
  thesis: {},
};

/** Returns the looks that this room has data for. */
export function looksOf({ wave, hasParticles, hasBreakers, gravityMps2, layers }: Pick<GreetingInfo, "wave" | "hasParticles" | "hasBreakers" | "gravityMps2" | "layers">): LookName[] {
  const has: Record<LookName, boolean> = {
    natural: true,
    height: wave !== undefined,
    velocity: wave !== undefined,
    breaking: wave !== undefined && hasBreakers && gravityMps2 > 0,
    foam: wave !== undefined && layers.includes("foam"),
    speed: hasParticles,
    density: hasParticles,
    thesis: true,
  };
  return kLookNames.filter((name) => has[name]);
}

/** Returns the look that the page's address asks for: `?look=height`. */
export function chooseLook(search: string): LookName {
  const wanted = new URLSearchParams(search).get("look");
  return kLookNames.find((name) => name === wanted) ?? "natural";
}

/** Returns true for looks of single particles, which need them in the plain packing: packed velocities and densities are too coarse. */
export function needsExactParticles(look: LookName): boolean {
  return kLooks[look].quantity?.of === "particles";
}

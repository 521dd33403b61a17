// The looks of the water: its natural one, data in colours, and the plain one of the thesis. Which quantities they show, how they are
// named, and which of them a room has data for. Pure.
import type { GreetingInfo } from "../../codec/greeting";
import { kDensityRatios } from "../frames/particle_values";
import type { ColourMapName } from "./colour_map";

const kLookNames = ["natural", "height", "velocity", "breaking", "foam", "speed", "density", "thesis"] as const;
export type LookName = (typeof kLookNames)[number];

/** What a look shows in colours. */
export interface Quantity {
  /** With its unit, for the colour bar. */
  title: string;
  unit: string;
  map: ColourMapName;
  /** Fixed bounds, or bounds that follow the values: signed ones around 0, others from 0 on. */
  range: { low: number; high: number; ticks?: number[] } | "signed" | "positive";
  /** Whose values: those of the surface or of single particles. */
  of: "surface" | "particles";
}

export interface Look {
  label: string;
  help: string;
  /** Undefined for looks without values. */
  quantity?: Quantity;
}

export const kLooks: Record<LookName, Look> = {
  natural: { label: "natural", help: "Water as light shows it." },
  height: {
    label: "height",
    help: "Elevation of the surface over the still water.",
    quantity: { title: "Surface height", unit: "m", map: "coolWarm", range: "signed", of: "surface" },
  },
  velocity: {
    label: "velocity",
    help: "Vertical velocity of the surface: the derivative by time of the streamed elevations. Positive where it rises.",
    quantity: { title: "Vertical surface velocity", unit: "m/s", map: "purpleGreen", range: "signed", of: "surface" },
  },
  breaking: {
    label: "breaking criterion",
    help:
      "Rate of rise of the surface, as a mean over 3 × 3 streamed samples, over √(g d) with the still depth d. The server lets the wave break above 0.65; once it breaks there, it continues " +
      "down to a threshold that falls to 0.15 (Kennedy et al. 2000). How long it has been breaking is not streamed: between 0.15 and 0.65 the colour does not tell whether it breaks.",
    quantity: { title: "Rate of rise / √(g d)", unit: "", map: "cividis", range: { low: 0, high: 1, ticks: [0, 0.15, 0.65, 1] }, of: "surface" },
  },
  foam: {
    label: "foam",
    help: "Streamed foam on the surface: the share of white.",
    quantity: { title: "Foam on the surface", unit: "%", map: "cividis", range: { low: 0, high: 100 }, of: "surface" },
  },
  speed: {
    label: "particle speed",
    help: "Magnitude of each particle's streamed velocity. The wave's surface is drawn plain, below the particles that it carries.",
    quantity: { title: "Particle speed", unit: "m/s", map: "viridis", range: "positive", of: "particles" },
  },
  density: {
    label: "particle density",
    help:
      "Streamed density of each particle over the density at rest, from 0.5 to 1.1; values beyond are shown as these. " +
      "Pressure is not streamed, and the 256 steps of the density are too coarse to compute it from.",
    quantity: { title: "Density / rest density", unit: "", map: "viridis", range: kDensityRatios, of: "particles" },
  },
  thesis: {
    label: "plain (thesis)",
    help: "As in the thesis: particles as spheres, whiter where their density is low, and the surface with Phong's lighting. The surface lies below the particles that it carries.",
  },
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

// The tiers of the drawing's quality, from a software renderer to a workstation, and which of them a page begins with. Pure.
import type { FloatType, HalfFloatType } from "three";

/** Settings of the particles' liquid. */
export interface FluidQuality {
  /** Cells of its volume along the spacing of the particles at rest. */
  cellsPerSpacing: number;
  /** Size of its picture as a share of the canvas. */
  scale: number;
  /** Drops drawn for each particle that flies apart from the liquid. */
  dropsCount: number;
  /** Texels along each side of the map of a tank's floor. */
  floorTexelsCount: number;
}

/** Settings of drops, foam and bubbles. */
export interface WhitewaterQuality {
  /** Most of them at a time. */
  capacityCount: number;
  /** How many begin, relative to the tier "high". */
  densityRatio: number;
  /** Texels of the foam's texture along each side of the square. */
  frothTexelsCount: number;
}

/** Settings of a tier. */
interface Tier {
  /** Most drawn pixels per CSS pixel, along each axis. */
  maxPixelRatio: number;
  /** The same in a tank of particles, whose liquid costs by the pixel. */
  tankPixelRatio: number;
  /** Frames per second, at most, that the page asks for; pictures between them are interpolated. */
  frameRateMaxHz: number;
  /** Cells along each side of the drawn surface. */
  surfaceCellsCount: number;
  /** Samples per pixel for solids. */
  samplesCount: number;
  /** Shaders and meshes without what is slow on software renderers. */
  plain: boolean;
  /** Draws sea, froth and flat shadows in every second picture. */
  sparing: boolean;
  /** Most texels along each side of the field texture; a finer surface is sampled. */
  fieldCountMax: number;
  /** Texels along each side of the two tiles of the sea around the square. */
  seaTexelsCount: number;
  /** Steps of a reflected ray in search of boats, rocks and walls; 0: water reflects only the sky. */
  mirrorStepsCount: number;
  /** Undefined: particles over a wave are drops alone, and those of a tank a mesh. */
  fluid: FluidQuality | undefined;
  whitewater: WhitewaterQuality;
  /** Rain: texels along each side of the tile with its rings, 0 without rings, and streaks in the air in the hardest rain. */
  rain: { ringTexelsCount: number; streaksCount: number };
  /** Grid and texture of the sunlight focused by waves; undefined: an approximation. */
  caustics: { cellsCount: number; texelsCount: number } | undefined;
  /** Texels along each side of the map of shadows; undefined: no such map. */
  shadows: { texelsCount: number } | undefined;
}

/** Settings of the scene. */
export interface Quality extends Tier {
  /** Numbers of the textures that the water and the sky sample: half floats, or floats, which software renderers sample faster. */
  texelType: TexelType;
}
export type TexelType = typeof HalfFloatType | typeof FloatType;

/** From the cheapest to the most expensive. */
export const kTierNames = ["minimal", "low", "medium", "high", "highest"] as const;
export type TierName = (typeof kTierNames)[number];
/** "automatic": by the time that pictures take. */
export type QualityChoice = TierName | "automatic";

export const kTiers: Record<TierName, Tier> = {
  minimal: {
    maxPixelRatio: 0.65, tankPixelRatio: 0.5, frameRateMaxHz: 10, surfaceCellsCount: 56, samplesCount: 1, plain: true, sparing: true, fieldCountMax: 128, seaTexelsCount: 96, mirrorStepsCount: 0,
    fluid: undefined, whitewater: { capacityCount: 1500, densityRatio: 0.3, frothTexelsCount: 192 },
    rain: { ringTexelsCount: 0, streaksCount: 1500 }, caustics: undefined, shadows: undefined,
  },
  low: {
    maxPixelRatio: 1, tankPixelRatio: 1, frameRateMaxHz: 30, surfaceCellsCount: 96, samplesCount: 1, plain: true, sparing: false, fieldCountMax: 256, seaTexelsCount: 128, mirrorStepsCount: 0,
    fluid: { cellsPerSpacing: 1, scale: 0.5, dropsCount: 4, floorTexelsCount: 256 }, whitewater: { capacityCount: 3000, densityRatio: 0.5, frothTexelsCount: 256 },
    rain: { ringTexelsCount: 0, streaksCount: 3000 }, caustics: undefined, shadows: undefined,
  },
  medium: {
    maxPixelRatio: 1, tankPixelRatio: 1, frameRateMaxHz: 60, surfaceCellsCount: 160, samplesCount: 2, plain: false, sparing: false, fieldCountMax: 512, seaTexelsCount: 256, mirrorStepsCount: 10,
    fluid: { cellsPerSpacing: 1.25, scale: 0.75, dropsCount: 6, floorTexelsCount: 256 }, whitewater: { capacityCount: 6000, densityRatio: 0.7, frothTexelsCount: 384 },
    rain: { ringTexelsCount: 256, streaksCount: 6000 }, caustics: { cellsCount: 128, texelsCount: 256 }, shadows: { texelsCount: 1024 },
  },
  high: {
    maxPixelRatio: 1.5, tankPixelRatio: 1.5, frameRateMaxHz: 60, surfaceCellsCount: 256, samplesCount: 4, plain: false, sparing: false, fieldCountMax: 4096, seaTexelsCount: 256, mirrorStepsCount: 18,
    fluid: { cellsPerSpacing: 1.5, scale: 1, dropsCount: 14, floorTexelsCount: 1024 }, whitewater: { capacityCount: 12_000, densityRatio: 1, frothTexelsCount: 512 },
    rain: { ringTexelsCount: 512, streaksCount: 10_000 }, caustics: { cellsCount: 192, texelsCount: 512 }, shadows: { texelsCount: 2048 },
  },
  highest: {
    maxPixelRatio: 2, tankPixelRatio: 2, frameRateMaxHz: 60, surfaceCellsCount: 384, samplesCount: 4, plain: false, sparing: false, fieldCountMax: 4096, seaTexelsCount: 512, mirrorStepsCount: 32,
    fluid: { cellsPerSpacing: 2, scale: 1, dropsCount: 18, floorTexelsCount: 2048 }, whitewater: { capacityCount: 24_000, densityRatio: 1.5, frothTexelsCount: 1024 },
    rain: { ringTexelsCount: 512, streaksCount: 16_000 }, caustics: { cellsCount: 384, texelsCount: 1024 }, shadows: { texelsCount: 4096 },
  },
};

/** Returns the choice that the page's address makes: `?quality=low`. */
export function chooseQuality(search: string): QualityChoice {
  const wanted = new URLSearchParams(search).get("quality");
  return kTierNames.find((name) => name === wanted) ?? "automatic";
}

/** Returns true if the name of a WebGL renderer is that of one without graphics hardware. */
export function isSoftware(rendererName: string): boolean {
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(rendererName);
}

/** Returns the tier that an automatic choice begins with: without graphics hardware the cheapest, whose first picture comes soonest. `isHandheld`: the device is operated by fingers. */
export function firstTier(isSoftwareRenderer: boolean, isHandheld: boolean): TierName {
  if (isSoftwareRenderer) return "minimal";
  return isHandheld ? "medium" : "high";
}

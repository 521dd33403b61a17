// Chooses the drawing quality: `?quality=low|high`, or by the name of the renderer. With ?quality=high the resolution is never lowered.

/** Settings of the particles' liquid. */
export interface FluidQuality {
  /** Size of its targets, as a share of the canvas. */
  scale: number;
  /** Samples of its filter on each side of a pixel, and how often the filter runs. */
  samplesCount: number;
  roundsCount: number;
}

/** Settings of drops, foam and bubbles. */
export interface WhitewaterQuality {
  /** Most of them at a time. */
  capacityCount: number;
  /** Share of the number that begins at full quality. */
  densityRatio: number;
  /** Texels of the foam's texture along each side of the square. */
  frothTexelsCount: number;
}

/** Settings of the scene. */
export interface Quality {
  /** Cells along each side of the drawn surface. */
  surfaceCellsCount: number;
  /** Samples per pixel for solids and the water's edge. */
  samplesCount: number;
  /** Shaders without the parts that are slow on software renderers: refraction and caustics of the wave. */
  plain: boolean;
  /** Most texels along each side of the field texture; a finer surface is sampled. */
  fieldCountMax: number;
  fluid: FluidQuality;
  whitewater: WhitewaterQuality;
  /** Grid and texture of the sunlight focused by waves; undefined: an approximation. */
  caustics: { cellsCount: number; texelsCount: number } | undefined;
  /** Texels along each side of the map of shadows; undefined: no such map. */
  shadows: { texelsCount: number } | undefined;
}

export interface ChosenQuality extends Quality {
  /** The resolution may be lowered to keep up. */
  adaptive: boolean;
  maxPixelRatio: number;
  /** For the HUD; empty at high quality. */
  remark: string;
}

const kHigh: ChosenQuality = { surfaceCellsCount: 256, samplesCount: 4, plain: false, fieldCountMax: 4096, fluid: { scale: 1, samplesCount: 12, roundsCount: 2 }, whitewater: { capacityCount: 12_000, densityRatio: 1, frothTexelsCount: 512 }, caustics: { cellsCount: 192, texelsCount: 512 }, shadows: { texelsCount: 2048 }, adaptive: true, maxPixelRatio: 2, remark: "" };
const kLow: ChosenQuality = { surfaceCellsCount: 72, samplesCount: 1, plain: true, fieldCountMax: 128, fluid: { scale: 0.5, samplesCount: 6, roundsCount: 2 }, whitewater: { capacityCount: 1500, densityRatio: 0.3, frothTexelsCount: 192 }, caustics: undefined, shadows: undefined, adaptive: true, maxPixelRatio: 1, remark: "low quality" };

export function chooseQuality(search: string, rendererName: string): ChosenQuality {
  const wanted = new URLSearchParams(search).get("quality");
  if (wanted === "high") return { ...kHigh, adaptive: false };
  if (wanted === "low") return kLow;
  if (/swiftshader|llvmpipe|softpipe|software|basic render/i.test(rendererName))
    return { ...kLow, remark: "low quality (no graphics hardware)" };
  return kHigh;
}

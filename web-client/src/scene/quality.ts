// How much to draw: `?quality=low|high`, or by the name of the renderer. High by request keeps its resolution.

export interface ChosenQuality {
  surfaceCellsCount: number;
  samplesCount: number;
  /** Shaders without what a software renderer pays dearly for: refraction, caustics, exact spheres. */
  plain: boolean;
  /** Texels a side of the field texture at most; a finer surface is sampled. */
  fieldCountMax: number;
  /** Whether the resolution may be lowered to keep up. */
  adaptive: boolean;
  maxPixelRatio: number;
  /** For the HUD; empty for the usual quality. */
  remark: string;
}

const kHigh: ChosenQuality = { surfaceCellsCount: 256, samplesCount: 4, plain: false, fieldCountMax: 4096, adaptive: true, maxPixelRatio: 2, remark: "" };
const kLow: ChosenQuality = { surfaceCellsCount: 72, samplesCount: 1, plain: true, fieldCountMax: 128, adaptive: true, maxPixelRatio: 1, remark: "low quality" };

export function chooseQuality(search: string, rendererName: string): ChosenQuality {
  const wanted = new URLSearchParams(search).get("quality");
  if (wanted === "high") return { ...kHigh, adaptive: false };
  if (wanted === "low") return kLow;
  if (/swiftshader|llvmpipe|softpipe|software|basic render/i.test(rendererName))
    return { ...kLow, remark: "low quality (no graphics hardware)" };
  return kHigh;
}

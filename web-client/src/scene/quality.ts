// How much to draw: `?quality=low|high`, or by the name of the renderer.

export interface ChosenQuality {
  surfaceCellsCount: number;
  samplesCount: number;
  maxPixelRatio: number;
  /** For the HUD; empty for the usual quality. */
  remark: string;
}

const kHigh: ChosenQuality = { surfaceCellsCount: 256, samplesCount: 4, maxPixelRatio: 2, remark: "" };
const kLow: ChosenQuality = { surfaceCellsCount: 112, samplesCount: 1, maxPixelRatio: 1, remark: "low quality" };

export function chooseQuality(search: string, rendererName: string): ChosenQuality {
  const wanted = new URLSearchParams(search).get("quality");
  if (wanted === "high") return kHigh;
  if (wanted === "low") return kLow;
  if (/swiftshader|llvmpipe|softpipe|software|basic render/i.test(rendererName))
    return { ...kLow, remark: "low quality (no graphics hardware)" };
  return kHigh;
}

// The ground under the samples as a texture, for level.frag and shore.frag.
import { DataTexture, FloatType, RGFormat } from "three";

import type { ShoreCells } from "./shore_ground";

/** Heights with obstacles and without them, metres; one texel per sample. The caller disposes it. */
export function makeCellsTexture({ resolutionCount, countZ, groundM, bedM }: ShoreCells): DataTexture {
  const heights = new Float32Array(2 * groundM.length);
  for (let at = 0; at < groundM.length; ++at) {
    heights[2 * at] = groundM[at]!;
    heights[2 * at + 1] = bedM[at]!;
  }
  const texture = new DataTexture(heights, resolutionCount, countZ, RGFormat, FloatType);
  texture.needsUpdate = true;
  return texture;
}

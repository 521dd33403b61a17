// The ground of a scene with a bed as a texture, for bed.glsl.
import { DataTexture, DataUtils, HalfFloatType, LinearFilter, RedFormat } from "three";

import type { Bed } from "./terrain";

/** Depths in metres, bilinear between the centres of cells; undefined for a bed that follows from beaches alone. The caller disposes it. */
export function makeGroundTexture({ ground }: Bed): DataTexture | undefined {
  if (!ground) return undefined;
  const depths = Uint16Array.from(ground.riseM, (riseM) => DataUtils.toHalfFloat(-riseM));
  const texture = new DataTexture(depths, ground.countX, ground.countZ, RedFormat, HalfFloatType);
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

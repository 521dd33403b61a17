// What the parts of a setting are built with, and what they tell the water.
import type { IUniform, RawShaderMaterial, Texture } from "three";

import type { SideKind, SideName } from "../../../client/codec/scene_info";
import type { Quality } from "../drawing/quality";
import type { Sky } from "../light/sky";
import type { OpenSea } from "../sea/open_sea";
import type { Uniforms } from "../shaders/materials";

export interface SurroundingsContext {
  sky: Sky;
  noise: Texture;
  field: Texture | undefined;
  /** Of caustics.glsl; undefined in the plain tiers, and where there is neither a wave nor a pool. */
  caustics: Uniforms | undefined;
  /** Of shadow.glsl; undefined: no map of shadows. */
  shadow: Uniforms | undefined;
  /** u_haze_m of the shaders: distance at which haze has half of the light; 0 without haze. */
  haze: IUniform<number>;
  /** Waves that the simulation does not have. */
  sea: OpenSea | undefined;
  /** Shared by rocks, land and lawns; the caller disposes it. */
  solid: RawShaderMaterial;
  quality: Pick<Quality, "plain">;
}

/** What bounds the water at its sides. */
export type WaterEdge =
  /** It continues as a sea, except at closed sides. */
  | { kind: "sea"; sea: Uniforms; sides: Readonly<Record<SideName, SideKind>> }
  /** Its sides are seen: a block of water, or water behind glass. */
  | { kind: "cut"; ripples: Uniforms | undefined }
  /** Walls, which others draw. */
  | { kind: "walls"; ripples: Uniforms | undefined };

// What the parts of a setting are built with.
import type { RawShaderMaterial, Texture } from "three";

import type { Quality } from "../quality";
import type { Sky } from "../sky";

export interface SurroundingsContext {
  sky: Sky;
  noise: Texture;
  field: Texture | undefined;
  /** Shared by rocks, land and lawns; the caller disposes it. */
  solid: RawShaderMaterial;
  quality: Pick<Quality, "plain">;
}

// Which objects cast shadows: those on these layers. The sky, the ground and the lids of boats do not.
import type { Object3D } from "three";

/** Layers of solids, and of floats, which the vertex shader moves (FLOATS in solid.vert). */
export const kCasterLayers = { solid: 1, float: 2 } as const;

export function castsShadow(object: Object3D, layer: keyof typeof kCasterLayers = "solid"): void {
  object.layers.enable(kCasterLayers[layer]);
}

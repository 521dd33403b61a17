// Which things cast shadows: those on these layers. The sky, the ground and the lids of boats do not.
import type { Object3D } from "three";

/** Layers of solids, and of what the vertex shader moves: buoys of the scene and instances of objects (FLOATS, INSTANCES in solid.vert). */
export const kCasterLayers = { solid: 1, float: 2, instance: 3 } as const;

export function castsShadow(object: Object3D, layer: keyof typeof kCasterLayers = "solid"): void {
  object.layers.enable(kCasterLayers[layer]);
}

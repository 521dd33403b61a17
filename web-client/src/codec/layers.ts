// The layers by name.
import { Layer } from "../gen/spindrift/v1/wire_pb";

export const kLayers = {
  surface: Layer.SURFACE,
  particles: Layer.PARTICLES,
  foam: Layer.FOAM,
  bodies: Layer.BODIES,
  diagnostics: Layer.DIAGNOSTICS,
} as const;

export type LayerName = keyof typeof kLayers;
export const kLayerNames = Object.keys(kLayers) as LayerName[];

/** The layers that are sent as frames; diagnostics have a message of their own. */
export type FrameLayer = Exclude<LayerName, "diagnostics">;

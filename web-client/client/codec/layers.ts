// The layers and their levels of detail, by name.
import { Layer, Level } from "../gen/spindrift/v1/wire_pb";

export const kLayers = {
  surface: Layer.SURFACE,
  particles: Layer.PARTICLES,
  foam: Layer.FOAM,
  bodies: Layer.BODIES,
  diagnostics: Layer.DIAGNOSTICS,
  floaters: Layer.FLOATERS,
} as const;

export type LayerName = keyof typeof kLayers;
export const kLayerNames = Object.keys(kLayers) as LayerName[];

/** The layers that are sent as frames; diagnostics have a message of their own. */
export type FrameLayer = Exclude<LayerName, "diagnostics">;

/** Coarsest first, as the server orders them. */
export const kLevels = [
  { name: "coarse", wire: Level.COARSE },
  { name: "medium", wire: Level.MEDIUM },
  { name: "fine", wire: Level.FINE },
  { name: "full", wire: Level.FULL },
] as const;

export type LevelName = (typeof kLevels)[number]["name"];

/** Leaves nothing out. */
export const kFinestLevel: LevelName = kLevels[kLevels.length - 1]!.name;

/** Returns the finest level for a value that this client does not know: the frame itself contains its resolution. */
export function levelName(wire: Level): LevelName {
  return kLevels.find((level) => level.wire === wire)?.name ?? kFinestLevel;
}

export function wireLevel(name: LevelName): Level {
  return kLevels[indexOf(name)]!.wire;
}

export function coarserLevel(a: LevelName, b: LevelName): LevelName {
  return kLevels[Math.min(indexOf(a), indexOf(b))]!.name;
}

function indexOf(name: LevelName): number {
  return kLevels.findIndex((level) => level.name === name);
}

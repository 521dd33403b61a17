// Levels of detail by name, coarsest first, as the server orders them.
import { Level } from "../gen/spindrift/v1/wire_pb";

export const kLevelNames = ["coarse", "medium", "fine", "full"] as const;
export type LevelName = (typeof kLevelNames)[number];

export const kLevels: Record<LevelName, Level> = { coarse: Level.COARSE, medium: Level.MEDIUM, fine: Level.FINE, full: Level.FULL };

/** Of a level that this client does not know: full, since nothing of it tells what would be left out. */
export function levelName(level: Level): LevelName {
  return kLevelNames.find((name) => kLevels[name] === level) ?? "full";
}

/** The coarser one of two. */
export function lowerLevel(a: LevelName, b: LevelName): LevelName {
  return kLevelNames[Math.min(kLevelNames.indexOf(a), kLevelNames.indexOf(b))]!;
}

// The rules of a lesson, as plain data that survives postMessage.
import { Tool, type Lesson } from "../gen/spindrift/v1/wire_pb";
import { malformed, type Malformed } from "./malformed";

/** What a player's command works with, in the order in which the page shows them. */
const kLessonTools = {
  finger: Tool.FINGER,
  splash: Tool.SPLASH,
  wave: Tool.WAVE,
  rain: Tool.RAIN,
  float: Tool.FLOAT,
  throw: Tool.THROW,
  boat: Tool.BOAT,
} as const;

export type LessonTool = keyof typeof kLessonTools;
export const kLessonToolNames = Object.keys(kLessonTools) as LessonTool[];

export interface LessonInfo {
  /** No player may do anything. */
  frozen: boolean;
  /** Handed out. */
  tools: LessonTool[];
  /** Share of a command's effect on the water that is left, at most 1. */
  forceRatio: number;
  teams: boolean;
}

/** What a room begins with. */
export const kFreeLesson: LessonInfo = { frozen: false, tools: kLessonToolNames, forceRatio: 1, teams: false };

export function readLesson({ frozen, tools, forceRatio = 1, teams }: Lesson): { lesson: LessonInfo } | Malformed {
  if (!(forceRatio > 0 && forceRatio <= 1)) return malformed(`lesson: force_ratio ${forceRatio} has to be above 0 and at most 1`);
  const handedOut = kLessonToolNames.filter((name) => tools.length === 0 || tools.includes(kLessonTools[name]));
  return { lesson: { frozen, tools: handedOut, forceRatio, teams } };
}

/** Returns the fields of a Lesson. An empty list means all tools, those that a newer server adds included. */
export function wireLesson({ frozen, tools, forceRatio, teams }: LessonInfo): { frozen: boolean; tools: Tool[]; forceRatio: number; teams: boolean } {
  const isAll = tools.length === kLessonToolNames.length;
  return { frozen, tools: isAll ? [] : tools.map((name) => kLessonTools[name]), forceRatio, teams };
}

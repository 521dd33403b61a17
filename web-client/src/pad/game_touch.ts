// What a phone says to the hand that holds it: marks, laps, the finish, a goal. Pure.
import type { GameInfo } from "../../client/codec/game";

/** Durations of vibration and pause in turn, ms. */
export const kPatterns = { mark: [20], lap: [60, 60, 60], finish: [120, 80, 120, 80, 250], goal: [200, 100, 200], start: [150] } as const;
type PatternName = keyof typeof kPatterns;

/** Returns what a change of the game means for a person; undefined: nothing. */
export function gameTouch(before: GameInfo | undefined, now: GameInfo | undefined, ownId: number): PatternName | undefined {
  if (!before || !now || before.kind !== now.kind) return undefined;
  if (before.phase === "countdown" && now.phase === "running") return "start";
  const [was, is] = [before, now].map(({ racers }) => racers.find(({ personId }) => personId === ownId));
  if (was && is) {
    if (is.finishedS > 0 && was.finishedS === 0) return "finish";
    if (is.lapsCount > was.lapsCount) return "lap";
    if (is.nextMark !== was.nextMark) return "mark";
  }
  return now.redGoalsCount + now.blueGoalsCount > before.redGoalsCount + before.blueGoalsCount ? "goal" : undefined;
}

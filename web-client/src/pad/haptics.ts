// What a phone says to the hand that holds it: knocks of one's boat, laps, the finish, a goal. Pure.
import type { GameInfo } from "../codec/game";

/** A knock: so much speed lost between two frames, at such a deceleration. */
const kKnockMps = 0.35;
const kKnockMps2 = 4;
/** Shortest time between two knocks. */
const kRestS = 0.4;

/** Durations of vibration and pause in turn, ms. */
export const kPatterns = { knock: [35], mark: [20], lap: [60, 60, 60], finish: [120, 80, 120, 80, 250], goal: [200, 100, 200], start: [150] } as const;
export type PatternName = keyof typeof kPatterns;

export class KnockSense {
  private last: { timeS: number; speedMps: number } | undefined;
  private knockedS = -Infinity;

  /** Returns true if the boat has hit something since the frame before. */
  feel(timeS: number, speedMps: number): boolean {
    const { last } = this;
    if (last && timeS === last.timeS) return false;
    this.last = { timeS, speedMps };
    if (!last || timeS < last.timeS) return false;
    const lostMps = Math.abs(last.speedMps) - Math.abs(speedMps);
    if (lostMps < kKnockMps || lostMps / (timeS - last.timeS) < kKnockMps2 || timeS - this.knockedS < kRestS) return false;
    this.knockedS = timeS;
    return true;
  }

  /** Another boat: its speed has nothing to do with that of the one before. */
  forget(): void {
    this.last = undefined;
  }
}

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

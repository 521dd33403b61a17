// Tells from the diagnostics whether the room's time runs slower than wanted. No DOM.
import { kTexts } from "./texts";

/** As the server's warning: below this share of the wanted speed the machine does not keep up. */
const kSlowPace = 0.9;
/** A pace above this ends the note. */
const kFullPace = 0.95;
const kPatienceS = 3;

export class PaceWatch {
  private slowSinceS: number | undefined;
  private fullSinceS: number | undefined;
  private isSlow = false;
  /** The last one that was slow: a moment at full speed does not end the note. */
  private slowPace = 1;

  /** Returns the note to show, or an empty text. `realTimeFactor` is 0 while the room is paused or asleep. */
  note(realTimeFactor: number, speed: number, nowS: number): string {
    const pace = speed > 0 ? realTimeFactor / speed : 0;
    if (!(pace > 0)) this.forget();
    else {
      this.slowSinceS = pace < kSlowPace ? (this.slowSinceS ?? nowS) : undefined;
      this.fullSinceS = pace >= kFullPace ? (this.fullSinceS ?? nowS) : undefined;
      if (pace < kSlowPace) this.slowPace = pace;
      if (this.slowSinceS !== undefined && nowS - this.slowSinceS >= kPatienceS) this.isSlow = true;
      if (this.fullSinceS !== undefined && nowS - this.fullSinceS >= kPatienceS) this.isSlow = false;
    }
    return this.isSlow ? kTexts.runsSlow(Math.round(100 * this.slowPace)) : "";
  }

  /** Other water: what was measured does not count. */
  forget(): void {
    this.slowSinceS = this.fullSinceS = undefined;
    this.isSlow = false;
  }
}

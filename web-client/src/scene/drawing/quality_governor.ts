// Chooses the tier and the resolution by the time that pictures take. Slow pictures lead down a ladder of rungs, fast ones up again. A rung
// that was too slow is tried again after a while, which doubles each time, so that the picture does not change back and forth. Pure.
import { kTierNames, kTiers, type QualityChoice, type TierName } from "./quality";

/** A rung of the ladder: a tier at its full resolution, or at a part of it. */
interface Rung {
  tier: TierName;
  resolutionShare: number;
}

/** From the cheapest to the most expensive; within a tier resolution comes before everything else. */
const kRungs: readonly Rung[] = kTierNames.flatMap((tier) => [0.75, 1].map((resolutionShare) => ({ tier, resolutionShare })));

/** Time between pictures that is too slow: at least 28 pictures per second where hardware can be expected, 20 elsewhere; for less sharpness than `minimal` has, 10. */
const kSlowMs: Record<TierName, number> = { minimal: 100, low: 50, medium: 36, high: 36, highest: 36 };
const kFastMs = 20;
/** The same on the last rung, with nine sixteenths of the pixels of the one above. */
const kLastFastMs = 60;
const kSlowForMs = 1500;
const kFastForMs = 10_000;
/** The same below the tier "medium" before the first fall: a page without graphics hardware begins with the cheapest tier. */
const kFirstFastForMs = 2000;
/** Pictures much too slow lead down several rungs at once: `[times too slow, rungs]`. */
const kFalls: readonly (readonly [number, number])[] = [[6, 4], [2.5, 2], [0, 1]];
/** One longer pause is a hidden page or a shader being compiled, not a slow picture. */
const kPauseMs = 1000;
/** Pictures left out after a new tier, whose programs are compiled, and after a new resolution. */
const kUnsettledCount = 3;
/** After a fall from a rung it is not tried again for so long, at first. */
const kFirstWaitMs = 30_000;

export class QualityGovernor {
  private choice: QualityChoice;
  private rung: number;
  private slowMs = 0;
  private slowCount = 0;
  private fastMs = 0;
  private isAfterPause = false;
  private unsettledCount = kUnsettledCount;
  private elapsedMs = 0;
  /** By rung: when it may be tried again, and how long that takes after the next fall. */
  private readonly notBeforeMs = kRungs.map(() => 0);
  private readonly waitMs = kRungs.map(() => kFirstWaitMs);

  /** `first`: the tier with which an automatic choice begins. */
  constructor(
    private readonly first: TierName,
    choice: QualityChoice,
  ) {
    this.choice = choice;
    this.rung = rungOf(choice === "automatic" ? first : choice);
  }

  get tier(): TierName {
    return kRungs[this.rung]!.tier;
  }

  get isAutomatic(): boolean {
    return this.choice === "automatic";
  }

  /** Drawn pixels per CSS pixel. `devicePixelRatio`: those of the device. `isTank`: the room is a tank of particles. */
  pixelRatio(devicePixelRatio: number, isTank = false): number {
    const { tier, resolutionShare } = kRungs[this.rung]!;
    const { maxPixelRatio, tankPixelRatio } = kTiers[tier];
    return Math.min(devicePixelRatio, isTank ? tankPixelRatio : maxPixelRatio) * resolutionShare;
  }

  /** Share of the tier's own resolution. */
  get resolutionShare(): number {
    return kRungs[this.rung]!.resolutionShare;
  }

  /** A tier chosen by hand stays, at its full resolution. */
  choose(choice: QualityChoice): void {
    this.choice = choice;
    this.moveTo(rungOf(choice === "automatic" ? this.first : choice));
  }

  /** Takes the time between two pictures. Returns true if tier or resolution changed. */
  note(frameMs: number): boolean {
    if (!this.isAutomatic) return false;
    this.elapsedMs += frameMs;
    const isPause = frameMs > kPauseMs && !this.isAfterPause;
    this.isAfterPause = frameMs > kPauseMs;
    if (isPause || this.unsettledCount > 0) {
      this.unsettledCount = Math.max(this.unsettledCount - 1, 0);
      return false;
    }
    const isSlow = frameMs > kSlowMs[this.tier];
    this.slowMs = isSlow ? this.slowMs + frameMs : 0;
    this.slowCount = isSlow ? this.slowCount + 1 : 0;
    this.fastMs = frameMs < (this.rung === 0 ? kLastFastMs : kFastMs) ? this.fastMs + frameMs : 0;
    return this.fallIfSlow() || this.riseIfFast();
  }

  private fallIfSlow(): boolean {
    if (this.slowMs < kSlowForMs || this.rung === 0) return false;
    const timesTooSlow = this.slowMs / this.slowCount / kSlowMs[this.tier];
    const [, rungs] = kFalls.find(([times]) => timesTooSlow >= times)!;
    this.notBeforeMs[this.rung] = this.elapsedMs + this.waitMs[this.rung]!;
    this.waitMs[this.rung]! *= 2;
    // Only pictures that are too slow at `minimal` itself lead below its resolution.
    this.moveTo(Math.max(this.rung - rungs, Math.min(this.rung - 1, rungOf("minimal"))));
    return true;
  }

  private riseIfFast(): boolean {
    const next = this.rung + 1;
    const isFirstClimb = this.tier !== "medium" && kTiers[this.tier].plain && this.waitMs.every((ms) => ms === kFirstWaitMs);
    if (this.fastMs < (isFirstClimb ? kFirstFastForMs : kFastForMs) || next >= kRungs.length || this.elapsedMs < this.notBeforeMs[next]!) return false;
    this.moveTo(next);
    return true;
  }

  private moveTo(rung: number): void {
    this.rung = rung;
    this.slowMs = this.slowCount = this.fastMs = 0;
    this.unsettledCount = kUnsettledCount;
  }
}

/** Returns the rung of a tier's full resolution. */
function rungOf(tier: TierName): number {
  return kRungs.findLastIndex((rung) => rung.tier === tier);
}

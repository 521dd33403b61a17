// A visit at a kiosk: the page attracts, is used, counts down when nobody touches it any more, and attracts again. Pure.

export type Phase = "attract" | "active" | "countdown";

/** Length of the countdown. */
const kCountdownS = 10;

export class Visit {
  phase: Phase = "attract";
  private sinceMs = 0;

  /** `idleS`: time without input until the countdown begins. */
  constructor(private readonly idleS: number) {}

  /** Somebody touched the page. */
  touched(nowMs: number): void {
    this.phase = "active";
    this.sinceMs = nowMs;
  }

  /** Call it at least once per second. */
  update(nowMs: number): void {
    if (this.phase === "active" && nowMs - this.sinceMs >= 1000 * this.idleS) {
      this.phase = "countdown";
      this.sinceMs = nowMs;
    }
    if (this.phase === "countdown" && this.secondsLeft(nowMs) <= 0) this.phase = "attract";
  }

  /** Whole seconds that the countdown shows. */
  secondsLeft(nowMs: number): number {
    return Math.max(Math.ceil(kCountdownS - (nowMs - this.sinceMs) / 1000), 0);
  }
}

// Trades resolution for speed: frames that stay slower than 50 ms lower the pixel ratio in steps down to 0.5; frames that stay
// fast raise it again, at most twice, so that it does not oscillate.

const kSlowMs = 50;
const kFastMs = 20;
const kSlowForMs = 1500;
const kFastForMs = 10_000;
const kStep = 0.75;
export const kMinPixelRatio = 0.5;
/** A longer pause is a hidden page, not a slow one. */
const kPauseMs = 2000;

export class FrameGovernor {
  pixelRatio: number;
  private slowMs = 0;
  private fastMs = 0;
  private raisesLeft = 2;

  /** `adaptive` false: the pixel ratio never changes. */
  constructor(
    private readonly wantedPixelRatio: number,
    private readonly adaptive = true,
  ) {
    this.pixelRatio = wantedPixelRatio;
  }

  /** Takes one frame's time; returns true if pixelRatio changed. */
  note(frameMs: number): boolean {
    if (!this.adaptive || frameMs > kPauseMs) return false;
    this.slowMs = frameMs > kSlowMs ? this.slowMs + frameMs : 0;
    this.fastMs = frameMs < kFastMs ? this.fastMs + frameMs : 0;
    if (this.slowMs >= kSlowForMs && this.pixelRatio > kMinPixelRatio) {
      this.slowMs = 0;
      this.pixelRatio = Math.max(this.pixelRatio * kStep, kMinPixelRatio);
      return true;
    }
    if (this.fastMs >= kFastForMs && this.raisesLeft > 0 && this.pixelRatio < this.wantedPixelRatio) {
      this.fastMs = 0;
      --this.raisesLeft;
      this.pixelRatio = Math.min(this.pixelRatio / kStep, this.wantedPixelRatio);
      return true;
    }
    return false;
  }

  /** For the HUD; empty at full quality. */
  remark(): string {
    return this.pixelRatio < this.wantedPixelRatio ? `resolution lowered to ${Math.round((this.pixelRatio / this.wantedPixelRatio) * 100)} % to keep up` : "";
  }
}

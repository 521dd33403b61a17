// Decides when an unattended page reloads itself: no picture for a while, or no connection. Each reload in a row waits twice as long. Pure.

/** Without a picture, without a connection, and at most for so long. */
const kNoPictureS = 30;
const kNoConnectionS = 120;
const kLongestS = 600;
/** After so long without trouble the next reload waits the shortest time again. */
const kHealthyS = 600;
/** A page that slept counts at most so much of the time. */
const kLongestStepS = 5;

export class Watchdog {
  private seenMs: number | undefined;
  private noPictureS = 0;
  private noConnectionS = 0;
  private healthyS = 0;
  private picturesCount = 0;

  /** `reloadsCount`: reloads in a row before this page. */
  constructor(private reloadsCount: number) {}

  /** Returns the reloads in a row, for the page after this one. */
  get reloads(): number {
    return this.reloadsCount;
  }

  pictureDrawn(): void {
    ++this.picturesCount;
  }

  /** Call it about once per second. Returns why the page has to reload; undefined: it works, or is given more time. */
  update(nowMs: number, { isVisible, isConnected }: { isVisible: boolean; isConnected: boolean }): string | undefined {
    const stepS = Math.min(Math.max(nowMs - (this.seenMs ?? nowMs), 0) / 1000, kLongestStepS);
    this.seenMs = nowMs;
    // Hidden pages draw nothing.
    this.noPictureS = isVisible && this.picturesCount === 0 ? this.noPictureS + stepS : 0;
    this.picturesCount = 0;
    this.noConnectionS = isConnected ? 0 : this.noConnectionS + stepS;
    this.healthyS = this.noPictureS === 0 && isConnected ? this.healthyS + stepS : 0;
    if (this.healthyS >= kHealthyS) this.reloadsCount = 0;
    if (this.noPictureS >= this.waitS(kNoPictureS)) return `no picture for ${Math.round(this.noPictureS)} s`;
    if (this.noConnectionS >= this.waitS(kNoConnectionS)) return `no connection for ${Math.round(this.noConnectionS)} s`;
    return undefined;
  }

  private waitS(firstS: number): number {
    return Math.min(firstS * 2 ** Math.min(this.reloadsCount, 16), kLongestS);
  }
}

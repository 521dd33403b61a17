// Which simulation time the page shows now. Frames come unevenly; the clock runs evenly, about two frame intervals
// behind the newest frame, so that there is nearly always a frame on either side to interpolate between.

const kWindowCount = 16;
/** Longer silence (pause, hidden page, lost link) says nothing about the rate of frames. */
const kGapS = 1.0;
const kDelayIntervals = 2;
const kSlewPerS = 2.5;
const kFirstIntervalS = 1 / 30;

export class PlayoutClock {
  private arrivals: { timeS: number; arrivedS: number }[] = [];
  private shownS: number | undefined;
  private shownAtS = 0;

  /** A frame of simulation time `timeS` came at client time `arrivedS`. Time going back (Reset) starts anew. */
  noteFrame(timeS: number, arrivedS: number): void {
    const last = this.arrivals.at(-1);
    if (last && timeS === last.timeS) return;
    if (last && timeS < last.timeS) this.reset();
    else if (last && arrivedS - last.arrivedS > kGapS) this.arrivals = [];
    this.arrivals.push({ timeS, arrivedS });
    if (this.arrivals.length > kWindowCount) this.arrivals.shift();
  }

  reset(): void {
    this.arrivals = [];
    this.shownS = undefined;
  }

  /** Simulated seconds between frames. */
  intervalS(): number {
    const count = this.arrivals.length;
    if (count < 2) return kFirstIntervalS;
    return (this.arrivals[count - 1]!.timeS - this.arrivals[0]!.timeS) / (count - 1);
  }

  /** Simulated seconds per client second. */
  rate(): number {
    const count = this.arrivals.length;
    if (count < 2) return 1;
    const first = this.arrivals[0]!;
    const last = this.arrivals[count - 1]!;
    const seconds = last.arrivedS - first.arrivedS;
    return seconds > 0 ? Math.min((last.timeS - first.timeS) / seconds, 4) : 1;
  }

  /** Simulation time to show at client time `nowS`; never runs back and never ahead of the newest frame. */
  displayTimeS(nowS: number): number | undefined {
    const newest = this.arrivals.at(-1);
    if (!newest) return this.shownS;
    const rate = this.rate();
    const intervalS = this.intervalS();
    const offsetS = this.arrivals.reduce((sum, a) => sum + a.timeS - rate * a.arrivedS, 0) / this.arrivals.length;
    const targetS = Math.min(offsetS + rate * nowS - kDelayIntervals * intervalS, newest.timeS);
    const elapsedS = Math.max(nowS - this.shownAtS, 0);
    this.shownAtS = nowS;
    const tooFarS = Math.max(0.5, 8 * intervalS);
    if (this.shownS === undefined || Math.abs(targetS - this.shownS) > tooFarS) {
      this.shownS = targetS;
    } else {
      const steadyS = this.shownS + rate * elapsedS;
      const slewedS = steadyS + (targetS - steadyS) * Math.min(1, kSlewPerS * elapsedS);
      this.shownS = Math.min(Math.max(slewedS, this.shownS), Math.max(newest.timeS, this.shownS));
    }
    return this.shownS;
  }
}

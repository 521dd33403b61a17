// Which simulation time the page shows now. Frames come unevenly; the clock runs evenly, as far behind the server as the frames
// of the last seconds took to come, so that there is nearly always one on either side to interpolate between.

/** Frames that rate and interval are taken from, and those that the jitter is. */
const kRateCount = 16;
const kJitterCount = 64;
/** Longer silence (pause, hidden page, lost link) says nothing about the rate of frames. */
const kGapS = 1.0;
const kDelayIntervals = 2;
/** Of the transits, this share is in time. */
const kInTimeShare = 0.95;
/** What is off is made good by running faster or slower: by this share of it a second, by so much at most. */
const kSlewPerS = 2.5;
const kMaxSlew = 0.1;
const kFirstIntervalS = 1 / 30;

interface Arrival {
  timeS: number;
  serverTimeS: number;
  arrivedS: number;
}

export class PlayoutClock {
  private arrivals: Arrival[] = [];
  private shownS: number | undefined;
  private shownAtS = 0;
  private leadS = 0;
  /** From the server's stamp to the picture, client seconds. */
  private behindS = 0;

  /** The server's clock minus the client's. */
  sync(leadS: number): void {
    this.leadS = leadS;
  }

  /**
   * A frame of simulation time `timeS`, which it was at the server's time `serverTimeS`, came at client time `arrivedS`. Time
   * going back (Reset) starts anew.
   */
  noteFrame(timeS: number, serverTimeS: number, arrivedS: number): void {
    const last = this.arrivals.at(-1);
    if (last && timeS === last.timeS) return;
    if (last && timeS < last.timeS) this.reset();
    else if (last && arrivedS - last.arrivedS > kGapS) this.arrivals = [];
    this.arrivals.push({ timeS, serverTimeS, arrivedS });
    if (this.arrivals.length > kJitterCount) this.arrivals.shift();
    this.behindS = this.neededDelayS();
  }

  reset(): void {
    this.arrivals = [];
    this.shownS = undefined;
  }

  /** Simulated seconds between frames. */
  intervalS(): number {
    const { count, timeS } = this.recent();
    return count > 0 ? timeS / count : kFirstIntervalS;
  }

  /** Simulated seconds per second of the server. */
  rate(): number {
    const { count, timeS, serverTimeS } = this.recent();
    return count > 0 && serverTimeS > 0 ? Math.min(timeS / serverTimeS, 4) : 1;
  }

  /** How far the picture is behind the server's water, client seconds; undefined before the first frame. */
  delayS(): number | undefined {
    return this.arrivals.length > 0 ? this.behindS : undefined;
  }

  /** Simulation time to show at client time `nowS`; never runs back and never ahead of the newest frame. */
  displayTimeS(nowS: number): number | undefined {
    const newest = this.arrivals.at(-1);
    if (!newest) return this.shownS;
    const rate = this.rate();
    const intervalS = this.intervalS();
    const serverNowS = nowS + this.leadS;
    const targetS = Math.min(newest.timeS + rate * (serverNowS - this.behindS - newest.serverTimeS), newest.timeS);
    const elapsedS = Math.max(nowS - this.shownAtS, 0);
    this.shownAtS = nowS;
    const tooFarS = Math.max(0.5, 8 * intervalS);
    if (this.shownS === undefined || Math.abs(targetS - this.shownS) > tooFarS) {
      this.shownS = targetS;
    } else {
      const steadyS = this.shownS + rate * elapsedS;
      const mostS = kMaxSlew * rate * elapsedS;
      const offS = (targetS - steadyS) * Math.min(1, kSlewPerS * elapsedS);
      const slewedS = steadyS + Math.min(Math.max(offS, -mostS), mostS);
      this.shownS = Math.min(Math.max(slewedS, this.shownS), Math.max(newest.timeS, this.shownS));
    }
    return this.shownS;
  }

  /** Between the newest frame and the one kRateCount before it. */
  private recent(): { count: number; timeS: number; serverTimeS: number } {
    const last = this.arrivals.at(-1);
    const first = this.arrivals.at(-1 - Math.min(kRateCount, this.arrivals.length - 1));
    if (!last || !first || last === first) return { count: 0, timeS: 0, serverTimeS: 0 };
    return {
      count: Math.min(kRateCount, this.arrivals.length - 1),
      timeS: last.timeS - first.timeS,
      serverTimeS: last.serverTimeS - first.serverTimeS,
    };
  }

  /**
   * The fastest transit, and on top of it two frame intervals, or, where that is more, the jitter (what 95 % of the frames take
   * longer at most) and the interval to the frame that is interpolated to.
   */
  private neededDelayS(): number {
    const { count, serverTimeS } = this.recent();
    const intervalS = count > 0 ? serverTimeS / count : kFirstIntervalS;
    const transitsS = this.arrivals.map((a) => a.arrivedS + this.leadS - a.serverTimeS).sort((a, b) => a - b);
    const fastestS = transitsS[0]!;
    const jitterS = transitsS[Math.ceil(kInTimeShare * transitsS.length) - 1]! - fastestS;
    return fastestS + Math.max(kDelayIntervals * intervalS, jitterS + intervalS);
  }
}

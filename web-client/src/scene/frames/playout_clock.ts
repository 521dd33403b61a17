// Chooses the simulation time to show. Frames arrive unevenly; this clock runs evenly, and far enough behind the server that there is
// nearly always a frame before and one after to interpolate between.
import { clamp } from "../maths/interpolate";

/** Number of frames over which rate and interval are measured, and over which the jitter is. */
const kRateCount = 16;
const kJitterCount = 64;
/** A longer gap (pause, hidden page, lost link) is not used for the frame rate. */
const kGapS = 1.0;
const kDelayIntervals = 2;
/** Share of the frames that arrive in time. */
const kInTimeShare = 0.95;
/** An error is corrected by running faster or slower: by kSlewPerS of it per second, at most by the share kMaxSlew of the rate. */
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
  /** Time from the server's stamp to the picture [client s]. */
  private behindS = 0;
  private heldS: number | undefined;

  /** Shows this time from now on, whatever time it is. */
  hold(timeS: number): void {
    this.heldS = timeS;
  }

  /** The server's clock minus the client's. */
  sync(leadS: number): void {
    this.leadS = leadS;
  }

  /**
   * Takes a frame of simulation time `timeS`, simulated at server time `serverTimeS`, that arrived at client time `arrivedS`.
   * Simulation time that goes back (Reset) restarts the clock.
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

  /** Returns the age of the water shown [client s]; undefined before the first frame. */
  delayS(): number | undefined {
    return this.arrivals.length > 0 ? this.behindS : undefined;
  }

  /** Returns the simulation time to show at client time `nowS`; it never runs back and never ahead of the newest frame. */
  displayTimeS(nowS: number): number | undefined {
    if (this.heldS !== undefined) return this.heldS;
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
      const slewedS = steadyS + clamp(offS, -mostS, mostS);
      this.shownS = clamp(slewedS, this.shownS, Math.max(newest.timeS, this.shownS));
    }
    return this.shownS;
  }

  /** Returns the differences between the newest frame and the one kRateCount before it. */
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
   * Returns the fastest transit plus the larger of: two frame intervals; or the jitter (95th percentile of the transits minus the
   * fastest) and one interval, for the frame that is interpolated to.
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

// Estimates the server's clock from pings. The ping with the shortest round trip counts, because its two ways can differ the least.
// Small corrections are made gradually, so that nothing timed by this clock jumps.

const kSampleCount = 8;
/** Clocks drift: older samples are dropped. */
const kSampleLifeMs = 60_000;
/** Correction per second for errors up to kSetBeyondMs; beyond that the clock is set at once. */
const kSlewPerS = 0.01;
const kSetBeyondMs = 250;

interface Sample {
  atMs: number;
  roundTripMs: number;
  leadMs: number;
}

export class ServerClock {
  private samples: Sample[] = [];
  private lead: number | undefined;
  private slewedAtMs = 0;

  /** First estimate, until the first pong. */
  greeted(serverTimeS: number, nowMs: number): void {
    this.samples = [];
    this.lead = serverTimeS * 1000 - nowMs;
    this.slewedAtMs = nowMs;
  }

  /** The pong of a ping sent at `sentMs` arrived at `nowMs`. */
  answered(sentMs: number, serverTimeS: number, nowMs: number): void {
    const roundTripMs = nowMs - sentMs;
    if (!(roundTripMs >= 0) || !Number.isFinite(serverTimeS)) return;
    const isFirst = this.samples.length === 0;
    this.samples.push({ atMs: nowMs, roundTripMs, leadMs: serverTimeS * 1000 - (sentMs + roundTripMs / 2) });
    this.samples = this.samples.filter(({ atMs }) => nowMs - atMs <= kSampleLifeMs).slice(-kSampleCount);
    const best = this.samples.reduce((a, b) => (b.roundTripMs < a.roundTripMs ? b : a));
    const errorMs = best.leadMs - (this.lead ?? best.leadMs);
    if (this.lead === undefined || isFirst || Math.abs(errorMs) > kSetBeyondMs) {
      this.lead = best.leadMs;
    } else {
      const mostMs = kSlewPerS * (nowMs - this.slewedAtMs);
      this.lead += Math.min(Math.max(errorMs, -mostMs), mostMs);
    }
    this.slewedAtMs = nowMs;
  }

  /** The server's clock minus the client's [ms]; undefined before the greeting. */
  leadMs(): number | undefined {
    return this.lead;
  }

  forget(): void {
    this.samples = [];
    this.lead = undefined;
  }
}

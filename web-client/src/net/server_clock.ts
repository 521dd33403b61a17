// What time it is at the server: of the last pings the one with the shortest round trip tells, because its way there and back
// can differ the least. Corrections come little by little, so that nothing that is timed by it jumps.

const kSampleCount = 8;
/** A sample older than this says nothing about clocks that drift. */
const kSampleLifeMs = 60_000;
/** Correction a second of a clock that is only a little off; one that is further off is set. */
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

  /** The greeting's time, as good as any before the first ping comes back. */
  greeted(serverTimeS: number, nowMs: number): void {
    this.samples = [];
    this.lead = serverTimeS * 1000 - nowMs;
    this.slewedAtMs = nowMs;
  }

  /** A ping of `sentMs` came back with the server's time at `nowMs`. */
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

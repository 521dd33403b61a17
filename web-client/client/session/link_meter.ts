// Measures the link: kB/s, frames/s, latency. Frames of several layers that show the same state count as one frame; for a server
// that does not number its states, the tick is used instead.
import type { FrameLayer } from "../codec/layers";
import type { LinkStats } from "./events";

const kRoundTripsKept = 5;
type MeteredStats = Omit<LinkStats, "linkLevel">;

/** A state older than the newest by less than this was counted already; by more, it is another room's. */
const kSameFrameStates = 30n;

export class LinkMeter {
  private readonly receivedCount = { surface: 0, particles: 0, foam: 0, bodies: 0, diagnostics: 0, floaters: 0 };
  private malformedCount = 0;
  private lastMalformed = "";
  private bytesCount = 0;
  private busyMs = 0;
  private busyShare = 0;
  private frameCount = 0;
  private lastState = -kSameFrameStates;
  private kilobytesPerS = 0;
  private framesPerS = 0;
  private roundTripsMs: number[] = [];

  constructor(private sinceMs: number) {}

  bytes(count: number): void {
    this.bytesCount += count;
  }

  frame(layer: FrameLayer, { stateId, tick }: { stateId: bigint; tick: bigint }): void {
    ++this.receivedCount[layer];
    const state = stateId !== 0n ? stateId : tick;
    // The layers of one state come in any order.
    if (state <= this.lastState && state > this.lastState - kSameFrameStates) return;
    ++this.frameCount;
    this.lastState = state;
  }

  diagnostics(): void {
    ++this.receivedCount.diagnostics;
  }

  /** Adds the time that one message took. */
  worked(ms: number): void {
    this.busyMs += ms;
  }

  malformed(reason: string): void {
    ++this.malformedCount;
    this.lastMalformed = reason;
  }

  roundTrip(ms: number): void {
    if (!Number.isFinite(ms) || ms < 0) return;
    this.roundTripsMs.push(ms);
    if (this.roundTripsMs.length > kRoundTripsKept) this.roundTripsMs.shift();
  }

  forgetRoundTrips(): void {
    this.roundTripsMs = [];
  }

  /** Returns the rates since the previous call, smoothed over about a second. */
  measure(nowMs: number): MeteredStats {
    const seconds = (nowMs - this.sinceMs) / 1000;
    if (seconds > 0) {
      this.kilobytesPerS += (this.bytesCount / 1000 / seconds - this.kilobytesPerS) * 0.6;
      this.framesPerS += (this.frameCount / seconds - this.framesPerS) * 0.6;
      this.busyShare = Math.min(this.busyMs / 1000 / seconds, 1);
      this.bytesCount = this.frameCount = this.busyMs = 0;
      this.sinceMs = nowMs;
    }
    return {
      kilobytesPerS: this.kilobytesPerS,
      framesPerS: this.framesPerS,
      latencyMs: this.roundTripsMs.length ? Math.min(...this.roundTripsMs) : undefined,
      busyShare: this.busyShare,
      receivedCount: { ...this.receivedCount },
      malformedCount: this.malformedCount,
      lastMalformed: this.lastMalformed,
    };
  }
}

// Counts what arrives and turns it into rates: kB/s, frames/s, latency. Frames of two layers that show one state are one
// frame; a server that does not number its states is taken by its ticks.
import type { FrameLayer, LinkStats } from "./messages";

const kRoundTripsKept = 5;
/** What is counted here. */
export type MeteredStats = Omit<LinkStats, "overtakenCount" | "level" | "levelHeldBy">;

/** A frame older than the newest by less than this is a late part of one that was counted; by more, another room's. */
const kSameFrameStates = 30n;

export class LinkMeter {
  private readonly receivedCount = { surface: 0, particles: 0, foam: 0, bodies: 0, diagnostics: 0 };
  private malformedCount = 0;
  private lastMalformed = "";
  private bytesCount = 0;
  private busyMs = 0;
  /** Share of the time between the last two measurements that messages took, 0..1. */
  busyShare = 0;
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
    // Layers of one state may come in any order, and one of them late.
    if (state <= this.lastState && state > this.lastState - kSameFrameStates) return;
    ++this.frameCount;
    this.lastState = state;
  }

  diagnostics(): void {
    ++this.receivedCount.diagnostics;
  }

  /** The worker was busy with a message for so long. */
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

  /** Rates since the call before this one; both smoothed over about a second. */
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
      receivedCount: { ...this.receivedCount },
      malformedCount: this.malformedCount,
      lastMalformed: this.lastMalformed,
    };
  }
}

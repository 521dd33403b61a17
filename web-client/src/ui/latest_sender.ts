// Sends the newest of many values at a bounded rate: the first at once, later ones after the shortest interval, the last one
// always. Clock and timers are injected.

export interface SenderWorld {
  nowMs(): number;
  setTimer(callback: () => void, ms: number): number;
  clearTimer(timer: number): void;
}

/** The clock and the timers of the page. */
export const kPageTime: SenderWorld = {
  nowMs: () => performance.now(),
  setTimer: (callback, ms) => window.setTimeout(callback, ms),
  clearTimer: (timer) => window.clearTimeout(timer),
};

export class LatestSender<T> {
  private sentAtMs = -Infinity;
  private timer: number | undefined;
  private waiting: { value: T } | undefined;

  constructor(
    private readonly send: (value: T) => void,
    private readonly world: SenderWorld,
    private readonly minIntervalMs: number,
  ) {}

  offer(value: T): void {
    this.waiting = { value };
    if (this.timer !== undefined) return;
    const waitMs = this.sentAtMs + this.minIntervalMs - this.world.nowMs();
    if (waitMs <= 0) return this.flush();
    this.timer = this.world.setTimer(() => this.flush(), waitMs);
  }

  /** Sends the waiting value now. */
  flush(): void {
    const waiting = this.waiting;
    this.cancel();
    if (!waiting) return;
    this.sentAtMs = this.world.nowMs();
    this.send(waiting.value);
  }

  /** Drops the waiting value. */
  cancel(): void {
    if (this.timer !== undefined) this.world.clearTimer(this.timer);
    this.timer = undefined;
    this.waiting = undefined;
  }
}

// Sends the newest of many values at a bounded rate: the first at once, later ones when their time has come, the last
// one always. No timers of its own, so tests drive it by hand.

export interface SenderWorld {
  nowMs(): number;
  setTimer(callback: () => void, ms: number): number;
  clearTimer(timer: number): void;
}

export class LatestSender<T> {
  private sentAtMs = -Infinity;
  private timer: number | undefined;
  private waiting: { value: T } | undefined;

  constructor(
    private readonly send: (value: T) => void,
    private readonly world: SenderWorld,
    private readonly leastMs: number,
  ) {}

  offer(value: T): void {
    this.waiting = { value };
    if (this.timer !== undefined) return;
    const waitMs = this.sentAtMs + this.leastMs - this.world.nowMs();
    if (waitMs <= 0) return this.flush();
    this.timer = this.world.setTimer(() => this.flush(), waitMs);
  }

  /** What waits goes now. */
  flush(): void {
    const waiting = this.waiting;
    this.cancel();
    if (!waiting) return;
    this.sentAtMs = this.world.nowMs();
    this.send(waiting.value);
  }

  /** What waits is forgotten. */
  cancel(): void {
    if (this.timer !== undefined) this.world.clearTimer(this.timer);
    this.timer = undefined;
    this.waiting = undefined;
  }
}

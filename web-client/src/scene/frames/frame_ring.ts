// The last few frames of a layer, oldest first. Owns their buffers until it returns them through `release`.

/** The frames before and after a time, their other neighbours (undefined: none), and the position of the time between them, 0..1. */
export interface Between<T> {
  before: T | undefined;
  from: T;
  to: T;
  after: T | undefined;
  mix: number;
}

export class FrameRing<T extends { timeS: number; stateId: bigint }> {
  private frames: T[] = [];
  private between: Between<T> | undefined;

  constructor(
    private readonly maxCount: number,
    private readonly release: (frame: T) => void,
  ) {}

  /**
   * A frame of the same state as the newest one replaces it: a paused room repeats its frames, perhaps at another level. Another
   * state at the same or an earlier time means a reset, or a change while paused: the old frames are released.
   */
  push(frame: T): void {
    const newest = this.newest();
    if (newest && frame.stateId !== 0n && frame.stateId === newest.stateId) {
      this.release(this.frames.pop()!);
      this.between = undefined;
    } else if (newest && frame.timeS <= newest.timeS) {
      this.clear();
    }
    this.frames.push(frame);
    if (this.frames.length > this.maxCount) this.release(this.frames.shift()!);
  }

  newest(): T | undefined {
    return this.frames.at(-1);
  }

  clear(): void {
    for (const frame of this.frames) this.release(frame);
    this.frames = [];
    this.between = undefined;
  }

  /**
   * Returns the frames around `timeS`; the same frame as `from` and `to` at the ends. The next call overwrites the result: this runs
   * for every layer of every picture.
   */
  around(timeS: number): Readonly<Between<T>> | undefined {
    const { frames } = this;
    if (frames.length === 0) return undefined;
    let after = 0;
    while (after < frames.length && frames[after]!.timeS <= timeS) ++after;
    const to = frames[Math.min(after, frames.length - 1)]!;
    const from = after === 0 ? to : frames[after - 1]!;
    const mix = from === to ? 0 : (timeS - from.timeS) / (to.timeS - from.timeS);
    const between = (this.between ??= { before: undefined, from, to, after: undefined, mix });
    between.before = frames[after - 2];
    between.from = from;
    between.to = to;
    between.after = frames[after + 1];
    between.mix = mix;
    return between;
  }
}

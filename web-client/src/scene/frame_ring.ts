// The last few frames of a layer, oldest first. Owns their buffers until it gives them back through `release`.

export class FrameRing<T extends { timeS: number }> {
  private frames: T[] = [];

  constructor(
    private readonly maxCount: number,
    private readonly release: (frame: T) => void,
  ) {}

  /** A frame not newer than the newest one means that the simulation started again: the old ones go. */
  push(frame: T): void {
    const newest = this.newest();
    if (newest && frame.timeS <= newest.timeS) this.clear();
    this.frames.push(frame);
    if (this.frames.length > this.maxCount) this.release(this.frames.shift()!);
  }

  newest(): T | undefined {
    return this.frames.at(-1);
  }

  clear(): void {
    for (const frame of this.frames) this.release(frame);
    this.frames = [];
  }

  /** The frames on either side of `timeS` and how far between them it lies, 0..1; both the same one at the ends. */
  around(timeS: number): { from: T; to: T; mix: number } | undefined {
    if (this.frames.length === 0) return undefined;
    const after = this.frames.findIndex((frame) => frame.timeS > timeS);
    if (after < 0) return { from: this.frames.at(-1)!, to: this.frames.at(-1)!, mix: 0 };
    if (after === 0) return { from: this.frames[0]!, to: this.frames[0]!, mix: 0 };
    const from = this.frames[after - 1]!;
    const to = this.frames[after]!;
    return { from, to, mix: (timeS - from.timeS) / (to.timeS - from.timeS) };
  }
}

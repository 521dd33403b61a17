// Frames of one layer on their way to the page: at most `maxUnderWay` delivered and not yet given back, plus one newest
// frame waiting. A slow page therefore never has more than that many messages to chew; older frames are overtaken.

/** Buffers come back by release(); the last few are kept for the next copies. */
export class FrameHandover<T extends { buffer: ArrayBuffer }> {
  overtakenCount = 0;
  private underWayCount = 0;
  private waiting: T | undefined;
  private readonly spares: ArrayBuffer[] = [];

  constructor(
    private readonly deliver: (frame: T) => void,
    private readonly maxUnderWay: number,
  ) {}

  /** A buffer of this size to copy the next payload into: a returned one where it fits. */
  takeBuffer(bytesCount: number): ArrayBuffer {
    const at = this.spares.findIndex((spare) => spare.byteLength === bytesCount);
    if (at < 0) {
      this.spares.length = 0;
      return new ArrayBuffer(bytesCount);
    }
    return this.spares.splice(at, 1)[0]!;
  }

  offer(frame: T): void {
    if (this.underWayCount < this.maxUnderWay) {
      ++this.underWayCount;
      this.deliver(frame);
      return;
    }
    if (this.waiting) {
      ++this.overtakenCount;
      this.keep(this.waiting.buffer);
    }
    this.waiting = frame;
  }

  release(buffer: ArrayBuffer): void {
    if (this.underWayCount === 0) return;
    --this.underWayCount;
    this.keep(buffer);
    const next = this.waiting;
    if (!next) return;
    this.waiting = undefined;
    ++this.underWayCount;
    this.deliver(next);
  }

  private keep(buffer: ArrayBuffer): void {
    if (buffer.byteLength > 0 && this.spares.length <= this.maxUnderWay) this.spares.push(buffer);
  }
}

// Frames of one layer on their way to the page: at most `maxUnderWay` delivered and not yet returned, plus the newest one waiting.
// A slow page has never more than that many messages in its queue; a waiting frame is superseded by a newer one.

const kMinGrowingBytes = 1024;

/** release() returns buffers; the last few are kept for the next payloads. */
export class FrameHandover<T extends { buffer: ArrayBuffer }> {
  supersededCount = 0;
  private underWayCount = 0;
  private waiting: T | undefined;
  private readonly spares: ArrayBuffer[] = [];

  constructor(
    private readonly deliver: (frame: T) => void,
    private readonly maxUnderWay: number,
    /** Payloads change their size: buffers have powers of two bytes and are used for any payload that fits. */
    private readonly isGrowing = false,
  ) {}

  /** Returns a buffer of at least this size for the next payload: a returned one if one fits. */
  takeBuffer(bytesCount: number): ArrayBuffer {
    const wanted = this.capacityOf(bytesCount);
    const at = this.spares.findIndex((spare) => (this.isGrowing ? spare.byteLength >= wanted : spare.byteLength === wanted));
    if (at < 0) {
      this.spares.length = 0;
      return new ArrayBuffer(wanted);
    }
    return this.spares.splice(at, 1)[0]!;
  }

  forgetSpares(): void {
    this.spares.length = 0;
  }

  offer(frame: T): void {
    if (this.underWayCount < this.maxUnderWay) {
      ++this.underWayCount;
      this.deliver(frame);
      return;
    }
    if (this.waiting) {
      ++this.supersededCount;
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

  private capacityOf(bytesCount: number): number {
    return this.isGrowing ? Math.max(2 ** Math.ceil(Math.log2(Math.max(bytesCount, 1))), kMinGrowingBytes) : bytesCount;
  }

  private keep(buffer: ArrayBuffer): void {
    if (buffer.byteLength > 0 && this.spares.length <= this.maxUnderWay) this.spares.push(buffer);
  }
}

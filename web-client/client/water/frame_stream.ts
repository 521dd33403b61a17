// Frames that wait for their reader: at most so many, the oldest make room and are counted.
import { SpindriftError } from "./errors";

/** `for await` gives every frame in order, but for those that `dropped` counts. Leaving the loop ends the stream. */
export class FrameStream<F> implements AsyncIterableIterator<F> {
  /** How many were dropped for newer ones because nobody took them in time. */
  dropped = 0;
  private readonly waiting: F[] = [];
  private readonly readers: { resolve: (result: IteratorResult<F>) => void; reject: (error: Error) => void }[] = [];
  private end: { error: Error | undefined } | undefined;

  constructor(
    readonly capacity: number,
    private readonly whenEnded: (stream: FrameStream<F>) => void,
  ) {
    if (!(Number.isInteger(capacity) && capacity >= 1 && capacity <= 4096)) throw new RangeError(`capacity ${capacity}: expected a whole number from 1 to 4096`);
  }

  /** How many wait. */
  get waitingCount(): number {
    return this.waiting.length;
  }

  put(frame: F): void {
    if (this.end) return;
    const reader = this.readers.shift();
    if (reader) return reader.resolve({ done: false, value: frame });
    this.waiting.push(frame);
    if (this.waiting.length <= this.capacity) return;
    this.waiting.shift();
    ++this.dropped;
  }

  /** Nothing comes any more: readers get what waits, then the error, or the end without one. */
  finish(error?: Error): void {
    if (this.end) return;
    this.end = { error };
    for (const reader of this.readers.splice(0)) error ? reader.reject(error) : reader.resolve({ done: true, value: undefined });
  }

  /** At most 64 calls wait at a time. */
  next(): Promise<IteratorResult<F>> {
    if (this.waiting.length > 0) return Promise.resolve({ done: false, value: this.waiting.shift()! });
    if (this.end) return this.end.error ? Promise.reject(this.end.error) : Promise.resolve({ done: true, value: undefined });
    if (this.readers.length >= 64) return Promise.reject(new SpindriftError("64 calls wait for the next frame of this stream already"));
    return new Promise((resolve, reject) => this.readers.push({ resolve, reject }));
  }

  return(): Promise<IteratorResult<F>> {
    this.waiting.length = 0;
    this.finish();
    this.whenEnded(this);
    return Promise.resolve({ done: true, value: undefined });
  }

  [Symbol.asyncIterator](): this {
    return this;
  }
}

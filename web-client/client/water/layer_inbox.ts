// The frames of one layer on their way to a program.
import { FrameStream } from "./frame_stream";

export class LayerInbox<F> {
  /** Holds the newest frame that was not taken yet. */
  private readonly newest = new FrameStream<F>(1, () => {});
  private readonly streams = new Set<FrameStream<F>>();
  private droppedBefore = 0;

  /** Frames that streams have dropped. */
  get dropped(): number {
    return [...this.streams].reduce((sum, stream) => sum + stream.dropped, this.droppedBefore);
  }

  put(frame: F): void {
    this.newest.put(frame);
    for (const stream of this.streams) stream.put(frame);
  }

  /** The newest frame that this did not return before; waits for one. */
  async next(): Promise<F> {
    return (await this.newest.next()).value;
  }

  /** Every frame from now on. */
  stream(capacity: number): FrameStream<F> {
    const stream = new FrameStream<F>(capacity, () => {
      if (this.streams.delete(stream)) this.droppedBefore += stream.dropped;
    });
    this.streams.add(stream);
    return stream;
  }

  /** Ends readers and streams with the error. Returns an inbox for those that follow, which counts on. */
  endedBy(error: Error): LayerInbox<F> {
    const next = new LayerInbox<F>();
    next.droppedBefore = this.dropped;
    this.finish(error, true);
    return next;
  }

  /** Nothing comes any more. Streams end with the error, or without one; waiting for a frame is an error in any case. */
  finish(error: Error, isFailure: boolean): void {
    this.newest.finish(error);
    for (const stream of this.streams) stream.finish(isFailure ? error : undefined);
  }
}

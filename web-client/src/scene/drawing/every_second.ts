// A pass that is drawn in every second picture: what it writes changes slowly, or is small in the picture.
import type { Pass, Picture, Resource } from "./pass";

export class EverySecond implements Pass {
  readonly name: string;
  readonly reads: readonly Resource[];
  readonly writes: readonly Resource[];
  private picturesCount = 0;

  /** `turn`: which of two pictures, so that not all such passes are drawn in the same one. All are drawn in the first. */
  constructor(
    private readonly pass: Pass,
    private readonly turn: 0 | 1,
  ) {
    this.name = pass.name;
    this.reads = pass.reads;
    this.writes = pass.writes;
  }

  draw(picture: Picture): void {
    if (this.picturesCount === 0 || this.picturesCount % 2 === this.turn) this.pass.draw(picture);
    ++this.picturesCount;
  }

  remember(picture: Picture): void {
    this.pass.remember?.(picture);
  }

  dispose(): void {
    this.pass.dispose();
  }
}

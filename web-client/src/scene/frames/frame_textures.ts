// Textures for the frames around the time shown. A frame is uploaded once, however often it is drawn.
import type { DataTexture } from "three";

interface Slot<F> {
  texture: DataTexture;
  frame: F | undefined;
}

/** Samples along x and along z. */
export interface PlaneCounts {
  resolutionCount: number;
  countZ: number;
}

interface PlaneFrame extends PlaneCounts {
  buffer: ArrayBuffer;
}

export class FrameTextures<F extends PlaneFrame> {
  private slots: Slot<F>[];

  /** `count`: frames that are drawn at the same time. */
  constructor(
    public counts: PlaneCounts,
    private readonly count: number,
    private readonly make: (counts: PlaneCounts) => DataTexture,
  ) {
    this.slots = this.makeSlots();
  }

  /** A texture before any frame is uploaded. */
  get blank(): DataTexture {
    return this.slots[0]!.texture;
  }

  /** Returns whether the textures have room for planes of this size. */
  fits({ resolutionCount, countZ }: PlaneCounts): boolean {
    return resolutionCount === this.counts.resolutionCount && countZ === this.counts.countZ;
  }

  resize(counts: PlaneCounts): void {
    this.dispose();
    this.counts = counts;
    this.slots = this.makeSlots();
  }

  /** Returns the texture that holds `frame`. If none does, uploads into a slot that holds none of `drawn`, at most `count` frames. */
  textureOf(frame: F, drawn: readonly (F | undefined)[]): DataTexture {
    const held = this.slots.find((slot) => slot.frame === frame);
    if (held) return held.texture;
    const slot = this.slots.find(({ frame: old }) => old === undefined || !drawn.includes(old))!;
    // A copy: the frame's buffer returns to the worker when the ring drops the frame, and the texture may be uploaded again after a
    // lost context.
    const { buffer, byteOffset, byteLength } = slot.texture.image.data as Uint8Array;
    new Uint8Array(buffer, byteOffset, byteLength).set(new Uint8Array(frame.buffer));
    slot.texture.needsUpdate = true;
    slot.frame = frame;
    return slot.texture;
  }

  dispose(): void {
    for (const slot of this.slots) slot.texture.dispose();
  }

  private makeSlots(): Slot<F>[] {
    return Array.from({ length: this.count }, () => ({ texture: this.make(this.counts), frame: undefined }));
  }
}

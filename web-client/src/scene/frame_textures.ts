// Textures for the frames around the time shown. A frame is uploaded once, however often it is drawn.
import type { DataTexture } from "three";

interface Slot<F> {
  texture: DataTexture;
  frame: F | undefined;
}

interface PlaneFrame {
  resolutionCount: number;
  buffer: ArrayBuffer;
}

export class FrameTextures<F extends PlaneFrame> {
  private slots: Slot<F>[];

  /** `count`: frames that are drawn at the same time. */
  constructor(
    public resolutionCount: number,
    private readonly count: number,
    private readonly make: (resolutionCount: number) => DataTexture,
  ) {
    this.slots = this.makeSlots();
  }

  /** A texture before any frame is uploaded. */
  get blank(): DataTexture {
    return this.slots[0]!.texture;
  }

  resize(resolutionCount: number): void {
    this.dispose();
    this.resolutionCount = resolutionCount;
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
    return Array.from({ length: this.count }, () => ({ texture: this.make(this.resolutionCount), frame: undefined }));
  }
}

// Two textures for the frames on either side of the time shown. A frame is uploaded once, however often it is drawn.
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
  private slots: [Slot<F>, Slot<F>];

  constructor(
    public resolutionCount: number,
    private readonly make: (resolutionCount: number) => DataTexture,
  ) {
    this.slots = [this.makeSlot(), this.makeSlot()];
  }

  /** The two textures before any frame is uploaded. */
  get textures(): [DataTexture, DataTexture] {
    return [this.slots[0].texture, this.slots[1].texture];
  }

  resize(resolutionCount: number): void {
    this.dispose();
    this.resolutionCount = resolutionCount;
    this.slots = [this.makeSlot(), this.makeSlot()];
  }

  /** Returns the texture that holds `frame`. If none does, uploads into the slot that does not hold `other`. */
  textureOf(frame: F, other: F): DataTexture {
    const held = this.slots.find((slot) => slot.frame === frame);
    if (held) return held.texture;
    const slot = this.slots[0].frame !== other ? this.slots[0] : this.slots[1];
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

  private makeSlot(): Slot<F> {
    return { texture: this.make(this.resolutionCount), frame: undefined };
  }
}

// Foam frames → two byte textures that the water blends between; nothing is uploaded twice.
import { ClampToEdgeWrapping, DataTexture, LinearFilter, RedFormat, RepeatWrapping, UnsignedByteType } from "three";

import type { FoamFrame } from "../net/messages";
import type { Uniforms } from "./shaders";

interface Slot {
  texture: DataTexture;
  frame: FoamFrame | undefined;
}

export class FoamField {
  /** For materials that show foam. */
  readonly uniforms: Uniforms;
  private slots: [Slot, Slot];
  private resolutionCount = 2;

  constructor(
    private readonly periodicX: boolean,
    private readonly periodicZ: boolean,
  ) {
    this.slots = [this.makeSlot(), this.makeSlot()];
    this.uniforms = { u_foam_from: { value: this.slots[0].texture }, u_foam_to: { value: this.slots[1].texture }, u_foam_mix: { value: 0 } };
  }

  /** Shows the foam `mix` of the way from one frame to the other. */
  show(from: FoamFrame, to: FoamFrame, mix: number): void {
    if (from.resolutionCount !== to.resolutionCount) from = to;
    if (from.resolutionCount !== this.resolutionCount) this.resize(from.resolutionCount);
    const slotFrom = this.slotOf(from, to);
    const slotTo = from === to ? slotFrom : this.slotOf(to, from);
    this.uniforms["u_foam_from"]!.value = slotFrom.texture;
    this.uniforms["u_foam_to"]!.value = slotTo.texture;
    this.uniforms["u_foam_mix"]!.value = mix;
  }

  dispose(): void {
    for (const slot of this.slots) slot.texture.dispose();
  }

  private resize(resolutionCount: number): void {
    this.dispose();
    this.resolutionCount = resolutionCount;
    this.slots = [this.makeSlot(), this.makeSlot()];
  }

  private makeSlot(): Slot {
    const n = this.resolutionCount;
    const texture = new DataTexture(new Uint8Array(n * n), n, n, RedFormat, UnsignedByteType);
    texture.minFilter = texture.magFilter = LinearFilter;
    texture.wrapS = this.periodicX ? RepeatWrapping : ClampToEdgeWrapping;
    texture.wrapT = this.periodicZ ? RepeatWrapping : ClampToEdgeWrapping;
    texture.unpackAlignment = 1;
    texture.needsUpdate = true;
    return { texture, frame: undefined };
  }

  /** The slot that holds `frame`; uploads into the one that does not hold `other` where none does. */
  private slotOf(frame: FoamFrame, other: FoamFrame): Slot {
    const [first, second] = this.slots;
    if (first.frame === frame) return first;
    if (second.frame === frame) return second;
    const slot = first.frame !== other ? first : second;
    // A copy, as with surfaces: the frame's buffer goes back to the worker.
    (slot.texture.image.data as Uint8Array).set(new Uint8Array(frame.buffer));
    slot.texture.needsUpdate = true;
    slot.frame = frame;
    return slot;
  }
}

// Surface frames → the field texture that every shader reads: elevation, slopes, curvature, at the time shown.
import {
  ClampToEdgeWrapping,
  DataTexture,
  HalfFloatType,
  LinearFilter,
  NearestFilter,
  RedIntegerFormat,
  RepeatWrapping,
  RGBAFormat,
  ShortType,
  Vector2,
  WebGLRenderTarget,
  type Texture,
  type WebGLRenderer,
} from "three";

import type { SurfaceFrame } from "../net/messages";
import { FullscreenPass } from "./fullscreen";
import { makeMaterial } from "./shaders";

interface Slot {
  texture: DataTexture;
  frame: SurfaceFrame | undefined;
}

export class FieldPass {
  /** Elevation (m), slope x, slope z, curvature (1/m); u along x and v along z, the water's square is 0..1. */
  readonly texture: Texture;
  private readonly target: WebGLRenderTarget;
  private readonly slots: [Slot, Slot];
  private readonly pass: FullscreenPass;

  /** Surfaces of `resolutionCount` samples a side, drawn into `fieldCount` (at most as many) texels a side. */
  constructor(
    private readonly resolutionCount: number,
    fieldCount: number,
    sideM: number,
    periodicX: boolean,
    periodicZ: boolean,
  ) {
    this.target = new WebGLRenderTarget(fieldCount, fieldCount, {
      format: RGBAFormat,
      type: HalfFloatType,
      minFilter: LinearFilter,
      magFilter: LinearFilter,
      wrapS: periodicX ? RepeatWrapping : ClampToEdgeWrapping,
      wrapT: periodicZ ? RepeatWrapping : ClampToEdgeWrapping,
      depthBuffer: false,
    });
    this.texture = this.target.texture;
    const makeSlot = (): Slot => {
      const samples = new Int16Array(resolutionCount * resolutionCount);
      const texture = new DataTexture(samples, resolutionCount, resolutionCount, RedIntegerFormat, ShortType);
      texture.internalFormat = "R16I";
      texture.minFilter = texture.magFilter = NearestFilter;
      texture.unpackAlignment = 2;
      texture.needsUpdate = true;
      return { texture, frame: undefined };
    };
    this.slots = [makeSlot(), makeSlot()];
    this.pass = new FullscreenPass(
      makeMaterial(
        "field",
        {
          u_from: { value: this.slots[0].texture },
          u_to: { value: this.slots[1].texture },
          u_quantum_m: { value: new Vector2(1, 1) },
          u_mix: { value: 0 },
          u_cell_m: { value: sideM / resolutionCount },
          u_cells_per_texel: { value: resolutionCount / fieldCount },
          u_periodic: { value: new Vector2(Number(periodicX), Number(periodicZ)) },
        },
        { depthTest: false, depthWrite: false },
      ),
    );
  }

  accepts(frame: SurfaceFrame): boolean {
    return frame.resolutionCount === this.resolutionCount;
  }

  /** Draws the field `mix` of the way from one frame to the other; uploads only frames not on the GPU yet. */
  render(renderer: WebGLRenderer, from: SurfaceFrame, to: SurfaceFrame, mix: number): void {
    const slotFrom = this.slotOf(from, to);
    const slotTo = from === to ? slotFrom : this.slotOf(to, from);
    const uniforms = this.pass.material.uniforms;
    uniforms["u_from"]!.value = slotFrom.texture;
    uniforms["u_to"]!.value = slotTo.texture;
    (uniforms["u_quantum_m"]!.value as Vector2).set(from.quantumM, to.quantumM);
    uniforms["u_mix"]!.value = mix;
    this.pass.render(renderer, this.target);
  }

  /** The water lies still: before the first frame, so that nothing stale is drawn. */
  renderStill(renderer: WebGLRenderer): void {
    const uniforms = this.pass.material.uniforms;
    (uniforms["u_quantum_m"]!.value as Vector2).set(0, 0);
    this.pass.render(renderer, this.target);
  }

  dispose(): void {
    this.target.dispose();
    this.pass.dispose();
    for (const slot of this.slots) slot.texture.dispose();
  }

  /** The slot that holds `frame`; uploads into the one that does not hold `other` where none does. */
  private slotOf(frame: SurfaceFrame, other: SurfaceFrame): Slot {
    const held = this.slots.find((slot) => slot.frame === frame);
    if (held) return held;
    const slot = this.slots.find((candidate) => candidate.frame !== other) ?? this.slots[0];
    // A copy: the frame's buffer goes back to the worker when the ring drops it, the texture may be uploaded again
    // after a lost context.
    (slot.texture.image.data as Int16Array).set(new Int16Array(frame.buffer));
    slot.texture.needsUpdate = true;
    slot.frame = frame;
    return slot;
  }
}

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
  private slots: [Slot, Slot];
  private readonly pass: FullscreenPass;

  /** Surfaces of `resolutionCount` samples a side at first, drawn into as many texels, at most `fieldCountMax` a side. */
  constructor(
    private resolutionCount: number,
    private readonly fieldCountMax: number,
    private readonly sideM: number,
    periodicX: boolean,
    periodicZ: boolean,
  ) {
    const fieldCount = Math.min(resolutionCount, fieldCountMax);
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
    this.slots = [this.makeSlot(), this.makeSlot()];
    this.pass = new FullscreenPass(
      makeMaterial(
        "field",
        {
          u_from: { value: this.slots[0].texture },
          u_to: { value: this.slots[1].texture },
          u_quantum_m: { value: new Vector2(1, 1) },
          u_mix: { value: 0 },
          u_cell_m: { value: 1 },
          u_cells_per_texel: { value: 1 },
          u_periodic: { value: new Vector2(Number(periodicX), Number(periodicZ)) },
        },
        { depthTest: false, depthWrite: false },
      ),
    );
    this.scale();
  }

  /** Draws the field `mix` of the way from one frame to the other; uploads only frames not on the GPU yet. */
  render(renderer: WebGLRenderer, from: SurfaceFrame, to: SurfaceFrame, mix: number): void {
    // Another level of detail: its first frame stands for the last one of the other.
    if (from.resolutionCount !== to.resolutionCount) from = to;
    if (to.resolutionCount !== this.resolutionCount) this.resize(to.resolutionCount);
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

  private resize(resolutionCount: number): void {
    for (const slot of this.slots) slot.texture.dispose();
    this.resolutionCount = resolutionCount;
    this.slots = [this.makeSlot(), this.makeSlot()];
    const fieldCount = Math.min(resolutionCount, this.fieldCountMax);
    this.target.setSize(fieldCount, fieldCount);
    this.scale();
  }

  private scale(): void {
    const uniforms = this.pass.material.uniforms;
    uniforms["u_cell_m"]!.value = this.sideM / this.resolutionCount;
    uniforms["u_cells_per_texel"]!.value = this.resolutionCount / this.target.width;
  }

  private makeSlot(): Slot {
    const n = this.resolutionCount;
    const texture = new DataTexture(new Int16Array(n * n), n, n, RedIntegerFormat, ShortType);
    texture.internalFormat = "R16I";
    texture.minFilter = texture.magFilter = NearestFilter;
    texture.unpackAlignment = 2;
    texture.needsUpdate = true;
    return { texture, frame: undefined };
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

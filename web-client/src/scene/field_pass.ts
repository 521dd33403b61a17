// Surface frames → the field texture that every shader reads: elevation, slopes and curvature at the time shown.
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
import { FrameTextures } from "./frame_textures";
import { FullscreenPass } from "./fullscreen";
import { makeMaterial } from "./shaders";

export class FieldPass {
  /** Elevation (m), slope x, slope z, curvature (1/m); u along x and v along z, the water's square is 0..1. */
  readonly texture: Texture;
  private readonly target: WebGLRenderTarget;
  private readonly frames: FrameTextures<SurfaceFrame>;
  private readonly pass: FullscreenPass;

  /** `resolutionCount`: samples per side of the first surface. The texture has as many texels, at most `fieldCountMax` per side. */
  constructor(
    resolutionCount: number,
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
    this.frames = new FrameTextures<SurfaceFrame>(resolutionCount, makeTexture);
    const [from, to] = this.frames.textures;
    this.pass = new FullscreenPass(
      makeMaterial(
        "field",
        {
          u_from: { value: from },
          u_to: { value: to },
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

  /** Draws the field `mix` of the way from one frame to the other. */
  render(renderer: WebGLRenderer, from: SurfaceFrame, to: SurfaceFrame, mix: number): void {
    // The level of detail changed: frames of two sizes cannot be interpolated.
    if (from.resolutionCount !== to.resolutionCount) from = to;
    if (to.resolutionCount !== this.frames.resolutionCount) this.resize(to.resolutionCount);
    const uniforms = this.pass.material.uniforms;
    uniforms["u_from"]!.value = this.frames.textureOf(from, to);
    uniforms["u_to"]!.value = this.frames.textureOf(to, from);
    (uniforms["u_quantum_m"]!.value as Vector2).set(from.quantumM, to.quantumM);
    uniforms["u_mix"]!.value = mix;
    this.pass.render(renderer, this.target);
  }

  /** Draws water at rest, until the first frame comes. */
  renderStill(renderer: WebGLRenderer): void {
    const uniforms = this.pass.material.uniforms;
    (uniforms["u_quantum_m"]!.value as Vector2).set(0, 0);
    this.pass.render(renderer, this.target);
  }

  dispose(): void {
    this.target.dispose();
    this.pass.dispose();
    this.frames.dispose();
  }

  private resize(resolutionCount: number): void {
    this.frames.resize(resolutionCount);
    const fieldCount = Math.min(resolutionCount, this.fieldCountMax);
    this.target.setSize(fieldCount, fieldCount);
    this.scale();
  }

  private scale(): void {
    const uniforms = this.pass.material.uniforms;
    uniforms["u_cell_m"]!.value = this.sideM / this.frames.resolutionCount;
    uniforms["u_cells_per_texel"]!.value = this.frames.resolutionCount / this.target.width;
  }
}

function makeTexture(n: number): DataTexture {
  const texture = new DataTexture(new Int16Array(n * n), n, n, RedIntegerFormat, ShortType);
  texture.internalFormat = "R16I";
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.unpackAlignment = 2;
  texture.needsUpdate = true;
  return texture;
}

// The density of the particles in cells: a volume, as horizontal slices side by side in one texture. Reads the particles. Writes density
// over that at rest, the white part of it, and in pools and tanks the part that moves fast.
import { LinearFilter, RGBAFormat, RGFormat, Vector2, Vector3, WebGLRenderTarget, type RawShaderMaterial } from "three";

import type { Pass, Picture } from "../drawing/pass";
import type { TexelType } from "../drawing/quality";
import { kAdding, makeMaterial, type Uniforms } from "../shaders/materials";
import type { FluidParticles } from "./fluid_particles";
import { volumeShape, type VolumeShape } from "./volume_shape";

/** Radius of a particle's kernel in spacings of the particles at rest. */
const kReachSpacings = 2.5;
/** Integral of (1 - r^2)^3 over the unit ball. */
const kKernelIntegral = 0.6383;

export class FluidVolumePass implements Pass {
  readonly name = "fluid volume";
  readonly reads = ["particles"] as const;
  readonly writes = ["fluidVolume"] as const;
  /** For the shaders that include fluid_volume.glsl. */
  readonly uniforms: Uniforms;
  private readonly target: WebGLRenderTarget;
  private readonly material: RawShaderMaterial;

  /** `size`: of the water, m. `surroundings`: with the floor of a tank; undefined in a wave. */
  constructor(
    private readonly particles: FluidParticles,
    private readonly size: { sideM: number; widthM: number },
    private readonly surroundings: { readonly floorM: number } | undefined,
    private readonly cellsPerSpacing: number,
    texelType: TexelType,
  ) {
    this.target = new WebGLRenderTarget(1, 1, { format: surroundings ? RGBAFormat : RGFormat, type: texelType, minFilter: LinearFilter, magFilter: LinearFilter, depthBuffer: false });
    this.uniforms = {
      u_volume: { value: this.target.texture },
      u_volume_min_m: { value: new Vector3() },
      u_volume_max_m: { value: new Vector3() },
      u_cell_m: { value: 1 },
      u_cells_count: { value: new Vector3(1, 1, 1) },
      u_slices_per_row: { value: 1 },
      u_reach_m: { value: 1 },
    };
    const uniforms = { ...particles.uniforms, ...this.uniforms, u_volume: { value: null }, u_slice: { value: 0 }, u_at_rest: { value: 1 }, u_target_px: { value: new Vector2() } };
    this.material = makeMaterial("fluidVolume", uniforms, { defines: surroundings ? { WALLS: 1 } : {}, ...kAdding });
  }

  draw({ renderer, camera }: Picture): void {
    const { particles, material } = this;
    if (particles.isEmpty) return;
    const { uniforms } = material;
    const spacingM = 2 * particles.radiusM;
    const reachM = kReachSpacings * spacingM;
    const { cellM } = this.place(reachM, spacingM / this.cellsPerSpacing);
    uniforms["u_at_rest"]!.value = kKernelIntegral * kReachSpacings ** 3;
    (uniforms["u_target_px"]!.value as Vector2).set(this.target.width, this.target.height);
    renderer.setRenderTarget(this.target);
    renderer.clear();
    const slicesCount = Math.ceil((2 * reachM) / cellM);
    for (let slice = 0; slice < slicesCount; ++slice) {
      uniforms["u_slice"]!.value = slice;
      material.uniformsNeedUpdate = true;
      particles.renderOver(renderer, camera, material, this.target);
    }
  }

  dispose(): void {
    this.target.dispose();
    this.material.dispose();
  }

  /** Puts the volume around the particles. */
  private place(reachM: number, finestM: number): VolumeShape {
    const { uniforms, size, surroundings, target } = this;
    const { minM, maxM } = this.particles.bounds;
    const shape = volumeShape(minM, maxM, reachM, finestM, surroundings && { ...size, floorM: surroundings.floorM });
    target.setSize(Math.max(target.width, shape.widthPx), Math.max(target.height, shape.heightPx));
    (uniforms["u_volume_min_m"]!.value as Vector3).fromArray(shape.minM);
    (uniforms["u_volume_max_m"]!.value as Vector3).fromArray(shape.maxM);
    (uniforms["u_cells_count"]!.value as Vector3).fromArray(shape.cellsCount);
    uniforms["u_cell_m"]!.value = shape.cellM;
    uniforms["u_slices_per_row"]!.value = shape.slicesPerRow;
    uniforms["u_reach_m"]!.value = reachM;
    return shape;
  }
}

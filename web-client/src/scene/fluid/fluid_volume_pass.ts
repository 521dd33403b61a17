// The density of the particles in cells: a volume, as horizontal slices side by side in one texture. Reads the particles. Writes density
// over that at rest, and the white share of it.
import { AddEquation, CustomBlending, HalfFloatType, LinearFilter, OneFactor, RGFormat, Vector2, Vector3, WebGLRenderTarget, type RawShaderMaterial } from "three";

import type { Pass, Picture } from "../drawing/pass";
import { makeMaterial, type Uniforms } from "../shaders/materials";
import type { FluidParticles } from "./fluid_particles";

/** Radius of a particle's kernel in spacings of the particles at rest. */
const kReachSpacings = 2.5;
/** Integral of (1 - r^2)^3 over the unit ball. */
const kKernelIntegral = 0.6383;
/** About so many cells are the most. */
const kMostCellsCount = 1_500_000;

export class FluidVolumePass implements Pass {
  readonly name = "fluid volume";
  readonly reads = ["particles"] as const;
  readonly writes = ["fluidVolume"] as const;
  /** For the shaders that include fluid_volume.glsl. */
  readonly uniforms: Uniforms;
  private readonly target = new WebGLRenderTarget(1, 1, { format: RGFormat, type: HalfFloatType, minFilter: LinearFilter, magFilter: LinearFilter, depthBuffer: false });
  private readonly material: RawShaderMaterial;

  /** `size`: of the water, m. `surroundings`: with the floor of a tank; undefined in a wave. */
  constructor(
    private readonly particles: FluidParticles,
    private readonly size: { sideM: number; widthM: number },
    private readonly surroundings: { readonly floorM: number } | undefined,
    private readonly cellsPerSpacing: number,
  ) {
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
    this.material = makeMaterial("fluidVolume", uniforms, { defines: surroundings ? { WALLS: 1 } : {}, blending: CustomBlending, blendEquation: AddEquation, blendSrc: OneFactor, blendDst: OneFactor, depthTest: false, depthWrite: false, transparent: true });
  }

  draw({ renderer, camera }: Picture): void {
    const { particles, material } = this;
    if (particles.isEmpty) return;
    const { uniforms } = material;
    const spacingM = 2 * particles.radiusM;
    const reachM = kReachSpacings * spacingM;
    const cellM = this.place(spacingM / this.cellsPerSpacing, reachM);
    uniforms["u_reach_m"]!.value = reachM;
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

  /** Puts the volume around the particles; in a tank its sides are those of the tank. Returns the side of its cells, which are larger where there would be too many. */
  private place(finestM: number, reachM: number): number {
    const { uniforms, size } = this;
    const floorM = this.surroundings?.floorM;
    const { minM, maxM } = this.particles.bounds;
    const half = [size.sideM / 2, 0, size.widthM / 2];
    const low = floorM === undefined ? minM.map((at) => at - reachM) : [-half[0]!, floorM, -half[2]!];
    const high = floorM === undefined ? maxM.map((at) => at + reachM) : [half[0]!, maxM[1]! + reachM, half[2]!];
    const lengths = low.map((at, axis) => high[axis]! - at);
    const cellM = Math.max(finestM, Math.cbrt((lengths[0]! * lengths[1]! * lengths[2]!) / kMostCellsCount));
    // In a wave the cells keep their places when the particles move, so that the surface does not tremble.
    const from = floorM === undefined ? low.map((at) => Math.floor(at / cellM) * cellM) : low;
    const [x, y, z] = from.map((at, axis) => Math.max(Math.ceil((high[axis]! - at) / cellM - 1e-3), 2)) as [number, number, number];
    const perRow = Math.max(Math.ceil(Math.sqrt((y * z) / x)), 1);
    this.target.setSize(Math.max(this.target.width, perRow * x), Math.max(this.target.height, Math.ceil(y / perRow) * z));
    (uniforms["u_volume_min_m"]!.value as Vector3).fromArray(from);
    (uniforms["u_volume_max_m"]!.value as Vector3).fromArray(high);
    (uniforms["u_cells_count"]!.value as Vector3).set(x, y, z);
    uniforms["u_cell_m"]!.value = cellM;
    uniforms["u_slices_per_row"]!.value = perRow;
    return cellM;
  }
}

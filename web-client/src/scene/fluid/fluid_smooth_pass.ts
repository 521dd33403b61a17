// Smooths the particles' surface (fluid_smooth.frag), along x and y in turn. Reads and writes 1 / distance [1/m] and foam.
import { Vector2, type RawShaderMaterial, type Texture, type WebGLRenderTarget, type WebGLRenderer } from "three";

import type { Pass, Picture } from "../drawing/pass";
import { makeMaterial } from "../shaders/materials";
import type { FluidDepthPass } from "./fluid_depth_pass";
import type { FluidParticles } from "./fluid_particles";
import { makeFrontTarget } from "./fluid_targets";
import type { FluidTilesPass } from "./fluid_tiles_pass";

/** Lengths of the filter in particle radii: half the kernel, and how far a pair's mean may lie from the pixel. */
const kReachRadii = 5;
const kRangeRadii = 2;

export class FluidSmoothPass implements Pass {
  readonly name = "fluid smooth";
  readonly reads = ["fluidTiles", "fluidFront"] as const;
  readonly writes = ["fluidSurface"] as const;
  /** The smoothed surface. */
  readonly target = makeFrontTarget(false);
  private readonly across = makeFrontTarget(false);
  private readonly material: RawShaderMaterial;

  /** `samplesCount`: on each side of a pixel. `roundsCount`: times that both axes are smoothed. */
  constructor(
    private readonly tiles: FluidTilesPass,
    private readonly particles: FluidParticles,
    private readonly depth: FluidDepthPass,
    samplesCount: number,
    private readonly roundsCount: number,
  ) {
    this.material = makeMaterial(
      "fluidSmooth",
      {
        ...tiles.uniforms,
        u_front: { value: null },
        u_axis: { value: new Vector2() },
        u_reach_m: { value: 1 },
        u_range_m: { value: 1 },
        u_px_per_m: { value: 1 },
      },
      { defines: { SAMPLES: samplesCount }, depthTest: false, depthWrite: false },
    );
  }

  draw({ renderer, camera }: Picture): void {
    const { uniforms } = this.material;
    const { radiusM } = this.particles;
    const front = this.depth.target;
    for (const target of [this.across, this.target]) target.setSize(front.width, front.height);
    uniforms["u_range_m"]!.value = kRangeRadii * radiusM;
    uniforms["u_px_per_m"]!.value = 0.5 * this.target.height * camera.projectionMatrix.elements[5]!;
    // Later rounds smooth what the first left, over a shorter length.
    for (let round = 0; round < this.roundsCount; ++round) {
      uniforms["u_reach_m"]!.value = (kReachRadii * radiusM) / (1 + round);
      this.smooth(renderer, round === 0 ? front.texture : this.target.texture, 1, 0, this.across);
      this.smooth(renderer, this.across.texture, 0, 1, this.target);
    }
  }

  dispose(): void {
    this.across.dispose();
    this.target.dispose();
    this.material.dispose();
  }

  private smooth(renderer: WebGLRenderer, from: Texture, x: number, y: number, to: WebGLRenderTarget): void {
    this.material.uniforms["u_front"]!.value = from;
    (this.material.uniforms["u_axis"]!.value as Vector2).set(x, y);
    renderer.setRenderTarget(to);
    renderer.clear();
    this.tiles.cover(renderer, this.material, to);
  }
}

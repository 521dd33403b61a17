// Draws the particles' nearest surface. Reads the particles. Writes 1 / distance [1/m] and foam.
import { Vector2, type RawShaderMaterial } from "three";

import type { Pass, Picture } from "../drawing/pass";
import { makeMaterial } from "../shaders/materials";
import type { FluidParticles } from "./fluid_particles";
import { makeFrontTarget } from "./fluid_targets";

export class FluidDepthPass implements Pass {
  readonly name = "fluid depth";
  readonly reads = ["particles"] as const;
  readonly writes = ["fluidFront"] as const;
  readonly target = makeFrontTarget(true);
  private readonly material: RawShaderMaterial;

  /** `scale`: size of the target as a share of the canvas. */
  constructor(
    private readonly particles: FluidParticles,
    private readonly scale: number,
  ) {
    this.material = makeMaterial("fluidDepth", { ...particles.uniforms, u_target_px: { value: new Vector2(1, 1) } });
  }

  draw(picture: Picture): void {
    this.particles.renderScaled(picture, this.material, this.target, this.scale);
  }

  dispose(): void {
    this.target.dispose();
    this.material.dispose();
  }
}

// Adds up the particles along each pixel's ray. Reads the particles. Writes thickness [m], weight, weight of particles
// among others, coverage.
import { Vector2, type RawShaderMaterial } from "three";

import type { Pass, Picture } from "../drawing/pass";
import { makeMaterial } from "../shaders/materials";
import type { FluidParticles } from "./fluid_particles";
import { makeHalfTarget, thicknessBlending } from "./fluid_targets";

export class FluidThicknessPass implements Pass {
  readonly name = "fluid thickness";
  readonly reads = ["particles"] as const;
  readonly writes = ["fluidThickness"] as const;
  readonly target = makeHalfTarget();
  private readonly material: RawShaderMaterial;

  /** `scale`: size of the target as a share of the canvas. */
  constructor(
    private readonly particles: FluidParticles,
    private readonly scale: number,
  ) {
    this.material = makeMaterial("fluidThickness", { ...particles.uniforms, u_target_px: { value: new Vector2(1, 1) } }, thicknessBlending);
  }

  draw(picture: Picture): void {
    this.particles.renderScaled(picture, this.material, this.target, this.scale);
  }

  dispose(): void {
    this.target.dispose();
    this.material.dispose();
  }
}

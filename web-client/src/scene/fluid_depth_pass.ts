// Draws the particles' nearest surface. Reads the particles. Writes 1 / distance [1/m] and foam.
import { Vector2, type PerspectiveCamera, type RawShaderMaterial, type WebGLRenderer } from "three";

import type { FluidParticles } from "./fluid_particles";
import { makeFrontTarget } from "./fluid_targets";
import { makeMaterial } from "./shaders";

export class FluidDepthPass {
  readonly target = makeFrontTarget(true);
  private readonly material: RawShaderMaterial;

  constructor(private readonly particles: FluidParticles) {
    this.material = makeMaterial("fluidDepth", { ...particles.uniforms, u_target_px: { value: new Vector2(1, 1) } });
  }

  resize(widthPx: number, heightPx: number): void {
    this.target.setSize(widthPx, heightPx);
    (this.material.uniforms["u_target_px"]!.value as Vector2).set(widthPx, heightPx);
  }

  render(renderer: WebGLRenderer, camera: PerspectiveCamera): void {
    this.particles.render(renderer, camera, this.material, this.target);
  }

  dispose(): void {
    this.target.dispose();
    this.material.dispose();
  }
}

// Adds up the particles along each pixel's ray. Reads the particles. Writes thickness [m], weight, weight of particles
// among others, coverage.
import { Vector2, type PerspectiveCamera, type RawShaderMaterial, type WebGLRenderer } from "three";

import type { FluidParticles } from "./fluid_particles";
import { makeHalfTarget, thicknessBlending } from "./fluid_targets";
import { makeMaterial } from "./shaders";

export class FluidThicknessPass {
  readonly target = makeHalfTarget();
  private readonly material: RawShaderMaterial;

  constructor(private readonly particles: FluidParticles) {
    this.material = makeMaterial("fluidThickness", { ...particles.uniforms, u_target_px: { value: new Vector2(1, 1) } }, thicknessBlending);
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

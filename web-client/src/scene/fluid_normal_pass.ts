// Normals of the smoothed surface. Reads 1 / distance [1/m] and foam. Writes the normal in view space and foam.
import { Vector4, type RawShaderMaterial, type Texture, type WebGLRenderer } from "three";

import { makeHalfTarget } from "./fluid_targets";
import type { FluidTilesPass } from "./fluid_tiles_pass";
import { makeMaterial } from "./shaders";

export class FluidNormalPass {
  readonly target = makeHalfTarget();
  private readonly material: RawShaderMaterial;

  constructor(private readonly tiles: FluidTilesPass) {
    this.material = makeMaterial("fluidNormal", { ...tiles.uniforms, u_front: { value: null }, u_ray: { value: new Vector4() } }, { depthTest: false, depthWrite: false });
  }

  resize(widthPx: number, heightPx: number): void {
    this.target.setSize(widthPx, heightPx);
  }

  /** `ray`: scale and offset from normalized device coordinates to view rays (x, y, -1). */
  render(renderer: WebGLRenderer, front: Texture, ray: Vector4): void {
    this.material.uniforms["u_front"]!.value = front;
    (this.material.uniforms["u_ray"]!.value as Vector4).copy(ray);
    renderer.setRenderTarget(this.target);
    renderer.clear();
    this.tiles.draw(renderer, this.material, this.target);
  }

  dispose(): void {
    this.target.dispose();
    this.material.dispose();
  }
}

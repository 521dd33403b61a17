// Normals of the smoothed surface. Reads 1 / distance [1/m] and foam. Writes the normal in view space and foam.
import { Vector4, type RawShaderMaterial } from "three";

import type { Pass, Picture } from "../drawing/pass";
import { makeMaterial } from "../shaders/materials";
import type { FluidSmoothPass } from "./fluid_smooth_pass";
import { makeHalfTarget } from "./fluid_targets";
import type { FluidTilesPass } from "./fluid_tiles_pass";
import { viewRay } from "./view_ray";

export class FluidNormalPass implements Pass {
  readonly name = "fluid normals";
  readonly reads = ["fluidTiles", "fluidSurface"] as const;
  readonly writes = ["fluidNormals"] as const;
  readonly target = makeHalfTarget();
  private readonly material: RawShaderMaterial;

  constructor(
    private readonly tiles: FluidTilesPass,
    private readonly smooth: FluidSmoothPass,
  ) {
    this.material = makeMaterial("fluidNormal", { ...tiles.uniforms, u_front: { value: smooth.target.texture }, u_ray: { value: new Vector4() } }, { depthTest: false, depthWrite: false });
  }

  draw({ renderer, camera }: Picture): void {
    this.target.setSize(this.smooth.target.width, this.smooth.target.height);
    viewRay(camera, this.material.uniforms["u_ray"]!.value as Vector4);
    renderer.setRenderTarget(this.target);
    renderer.clear();
    this.tiles.cover(renderer, this.material, this.target);
  }

  dispose(): void {
    this.target.dispose();
    this.material.dispose();
  }
}

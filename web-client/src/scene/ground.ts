// The floor under and around the water, out to the haze.
import { CircleGeometry, Mesh, Vector2, Vector3, type RawShaderMaterial, type Texture } from "three";

import { makeMaterial, type Uniforms } from "./shaders";
import type { Sky } from "./sky";

export class Ground {
  readonly mesh: Mesh<CircleGeometry, RawShaderMaterial>;
  private readonly uniforms: Uniforms;

  /** `field` undefined: no water above the floor. */
  constructor(sky: Sky, field: Texture | undefined, sideM: number, widthM: number, depthM: number, plain: boolean) {
    this.uniforms = {
      ...sky.uniforms,
      u_camera_m: { value: new Vector3() },
      u_field: { value: field ?? null },
      u_side_m: { value: sideM },
      u_half_m: { value: new Vector2(sideM / 2, widthM / 2) },
      u_depth_m: { value: depthM },
      u_has_water: { value: field !== undefined },
    };
    const geometry = new CircleGeometry(40 * sideM, 64);
    geometry.rotateX(-Math.PI / 2);
    this.mesh = new Mesh(geometry, makeMaterial("ground", this.uniforms, { defines: plain ? { PLAIN: 1 } : {} }));
    this.mesh.frustumCulled = false;
    this.lowerTo(-depthM);
  }

  lowerTo(yM: number): void {
    this.mesh.position.y = yM;
  }

  update(cameraM: Vector3): void {
    (this.uniforms["u_camera_m"]!.value as Vector3).copy(cameraM);
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

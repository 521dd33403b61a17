// Shades the fluid over the picture (fluid_surface.frag). Reads the smoothed surface, its normals, the thickness, and the solids' colour
// and depth. Writes the canvas and its depth.
import { Matrix4, Vector2, Vector3, Vector4, type PerspectiveCamera, type RawShaderMaterial, type Texture, type WebGLRenderer } from "three";

import type { FluidTilesPass } from "./fluid_tiles_pass";
import { makeMaterial, type Uniforms } from "./shaders";
import type { Sky } from "./sky";
import type { BehindTextures } from "./water_body";

export class FluidSurfacePass {
  private readonly material: RawShaderMaterial;

  /** `hasWave`: the fluid is one body with the wave, whose textures are in `particleUniforms`. */
  constructor(private readonly tiles: FluidTilesPass, sky: Sky, noise: Texture, particleUniforms: Uniforms, hasWave: boolean, colourRatio: number) {
    this.material = makeMaterial(
      "fluidSurface",
      {
        ...sky.uniforms,
        ...tiles.uniforms,
        ...particleUniforms,
        u_noise: { value: noise },
        u_front: { value: null },
        u_normals: { value: null },
        u_thickness: { value: null },
        u_behind: { value: null },
        u_behind_depth: { value: null },
        u_ray: { value: new Vector4() },
        u_near_far_m: { value: new Vector2(1, 2) },
        u_projection: { value: new Matrix4() },
        u_camera_world: { value: new Matrix4() },
        u_camera_m: { value: new Vector3() },
        u_colour_ratio: { value: colourRatio },
      },
      { defines: hasWave ? { WAVE: 1 } : {}, transparent: true },
    );
  }

  render(renderer: WebGLRenderer, camera: PerspectiveCamera, textures: { front: Texture; normals: Texture; thickness: Texture }, behind: BehindTextures, ray: Vector4): void {
    const { uniforms } = this.material;
    uniforms["u_front"]!.value = textures.front;
    uniforms["u_normals"]!.value = textures.normals;
    uniforms["u_thickness"]!.value = textures.thickness;
    uniforms["u_behind"]!.value = behind.color;
    uniforms["u_behind_depth"]!.value = behind.depth;
    (uniforms["u_ray"]!.value as Vector4).copy(ray);
    (uniforms["u_near_far_m"]!.value as Vector2).set(camera.near, camera.far);
    (uniforms["u_projection"]!.value as Matrix4).copy(camera.projectionMatrix);
    (uniforms["u_camera_world"]!.value as Matrix4).copy(camera.matrixWorld);
    (uniforms["u_camera_m"]!.value as Vector3).copy(camera.position);
    this.tiles.draw(renderer, this.material, null);
  }

  dispose(): void {
    this.material.dispose();
  }
}

// Shades the fluid over the picture (fluid_surface.frag). Reads the smoothed surface, its normals, the thickness, and the solids' colour
// and depth. Writes the canvas and its depth.
import { Matrix4, Vector2, Vector3, Vector4, type RawShaderMaterial, type Texture } from "three";

import type { Pass, Picture } from "../drawing/pass";
import type { Sky } from "../light/sky";
import { makeMaterial, type Uniforms } from "../shaders/materials";
import type { SolidsPass } from "../solids/solids_pass";
import type { FluidTilesPass } from "./fluid_tiles_pass";
import type { FluidVolumePass } from "./fluid_volume_pass";
import { viewRay } from "./view_ray";

/** What the surface is shaded from. */
interface FluidSurfaceInputs {
  tiles: FluidTilesPass;
  volume: FluidVolumePass;
  solids: SolidsPass;
}

export class FluidSurfacePass implements Pass {
  readonly name = "fluid surface";
  readonly reads = ["fluidTiles", "fluidVolume", "solids", "canvas"] as const;
  readonly writes = ["canvas"] as const;
  private readonly tiles: FluidTilesPass;
  private readonly solids: SolidsPass;
  private readonly material: RawShaderMaterial;

  /** `hasWave`: the fluid is one body with the wave, whose textures are in `particleUniforms`. */
  constructor({ tiles, volume, solids }: FluidSurfaceInputs, sky: Sky, noise: Texture, particleUniforms: Uniforms, hasWave: boolean, colourRatio: number) {
    this.tiles = tiles;
    this.solids = solids;
    const { color, depth } = solids.textures;
    this.material = makeMaterial(
      "liquid",
      {
        ...sky.uniforms,
        ...tiles.uniforms,
        ...particleUniforms,
        ...volume.uniforms,
        u_behind: { value: color },
        u_behind_depth: { value: depth },
        u_ray: { value: new Vector4() },
        u_near_far_m: { value: new Vector2(1, 2) },
        u_projection: { value: new Matrix4() },
        u_camera_world: { value: new Matrix4() },
        u_camera_m: { value: new Vector3() },
        u_floor_m: { value: 0 },
        u_noise: { value: noise },
        u_colour_ratio: { value: colourRatio },
      },
      { defines: hasWave ? { WAVE: 1 } : {}, transparent: true },
    );
  }

  draw({ renderer, camera }: Picture): void {
    const { uniforms } = this.material;
    viewRay(camera, uniforms["u_ray"]!.value as Vector4);
    (uniforms["u_near_far_m"]!.value as Vector2).set(camera.near, camera.far);
    (uniforms["u_projection"]!.value as Matrix4).copy(camera.projectionMatrix);
    (uniforms["u_camera_world"]!.value as Matrix4).copy(camera.matrixWorld);
    (uniforms["u_camera_m"]!.value as Vector3).copy(camera.position);
    uniforms["u_floor_m"]!.value = this.solids.surroundings.floorM;
    this.tiles.cover(renderer, this.material);
  }

  dispose(): void {
    this.material.dispose();
  }
}

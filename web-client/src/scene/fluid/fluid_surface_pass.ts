// Shades the liquid over the picture (fluid_surface.frag). Reads the volume, and the solids' colour and depth. Writes the canvas and its
// depth.
import { DepthTexture, Matrix4, UnsignedIntType, Vector2, Vector3, Vector4, WebGLRenderTarget, type RawShaderMaterial, type Texture } from "three";

import type { Pass, Picture } from "../drawing/pass";
import type { FluidQuality } from "../drawing/quality";
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
  sky: Sky;
  noise: Texture;
  particleUniforms: Uniforms;
  /** Of FluidShadowPass; undefined: the liquid is one body with a wave, whose textures are in `particleUniforms`. */
  floorUniforms: Uniforms | undefined;
  /** Foam that boats leave, from above. */
  froth: Texture | undefined;
}

/** Size of one tile of the foam's lace. */
const kLaceM = 1.1;

export class FluidSurfacePass implements Pass {
  readonly name = "fluid surface";
  readonly reads = ["fluidTiles", "fluidVolume", "fluidFloor", "sea", "froth", "solids", "canvas"] as const;
  readonly writes = ["canvas"] as const;
  private readonly tiles: FluidTilesPass;
  private readonly solids: SolidsPass;
  private readonly material: RawShaderMaterial;
  private readonly scale: number;
  /** Where the picture is smaller than the canvas: it, and what draws it on the canvas. */
  private readonly small: { target: WebGLRenderTarget; material: RawShaderMaterial } | undefined;

  /** `colourRatio`: water_optics.ts. */
  constructor({ tiles, volume, solids, sky, noise, particleUniforms, floorUniforms, froth }: FluidSurfaceInputs, colourRatio: number, { scale }: FluidQuality, plain: boolean) {
    this.tiles = tiles;
    this.solids = solids;
    this.scale = scale;
    const { color, depth } = solids.textures;
    const { edge } = solids.surroundings;
    const ripples = edge.kind === "sea" ? edge.sea : edge.ripples;
    this.material = makeMaterial(
      "fluidSurface",
      {
        ...sky.uniforms,
        ...tiles.uniforms,
        ...particleUniforms,
        ...volume.uniforms,
        ...floorUniforms,
        ...ripples,
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
        u_froth: { value: froth },
        u_lace_m: { value: kLaceM },
      },
      { defines: { ...(floorUniforms ? !plain && { AGAIN: 1 } : { WAVE: 1 }), ...(ripples && { RIPPLES: 1 }), ...(edge.kind === "cut" && { GLASS: 1 }), ...(froth && { FROTH: 1, HEAPED: 1 }) }, transparent: true },
    );
    if (scale === 1) return;
    const target = new WebGLRenderTarget(1, 1);
    target.depthTexture = new DepthTexture(1, 1, UnsignedIntType);
    const uniforms = { ...tiles.uniforms, u_liquid: { value: target.texture }, u_depth: { value: target.depthTexture } };
    this.small = { target, material: makeMaterial("fluidPresent", uniforms, { transparent: true, premultipliedAlpha: true }) };
  }

  draw({ renderer, camera, sizePx }: Picture): void {
    const { tiles, small, material, scale } = this;
    const { uniforms } = material;
    viewRay(camera, uniforms["u_ray"]!.value as Vector4);
    (uniforms["u_near_far_m"]!.value as Vector2).set(camera.near, camera.far);
    (uniforms["u_projection"]!.value as Matrix4).copy(camera.projectionMatrix);
    (uniforms["u_camera_world"]!.value as Matrix4).copy(camera.matrixWorld);
    (uniforms["u_camera_m"]!.value as Vector3).copy(camera.position);
    uniforms["u_floor_m"]!.value = this.solids.surroundings.floorM;
    if (!small) return tiles.cover(renderer, material, null);
    small.target.setSize(Math.ceil(sizePx.x * scale), Math.ceil(sizePx.y * scale));
    renderer.setRenderTarget(small.target);
    renderer.clear();
    tiles.cover(renderer, material, small.target);
    tiles.cover(renderer, small.material, null);
  }

  dispose(): void {
    this.material.dispose();
    this.small?.target.depthTexture?.dispose();
    this.small?.target.dispose();
    this.small?.material.dispose();
  }
}

// Particles as one liquid, in screen space: the passes in order. Their targets may be smaller than the canvas; the last pass draws on it.
//   shadow     particles -> light on the floor of a tank, before the canvas is drawn
//   tiles      particles -> tiles of the screen with fluid; the screen passes below run there only
//   depth      particles -> nearest surface
//   smooth     nearest surface -> smooth surface
//   normal     smooth surface -> normals
//   thickness  particles -> thickness, coverage
//   surface    all of these, sky, solids -> canvas
import { Vector2, Vector4, type PerspectiveCamera, type Texture, type WebGLRenderer, type WebGLRenderTarget } from "three";

import type { ParticleFrame } from "../net/messages";
import { FluidDepthPass } from "./fluid_depth_pass";
import { FluidNormalPass } from "./fluid_normal_pass";
import { FluidParticles } from "./fluid_particles";
import { FluidShadowPass } from "./fluid_shadow_pass";
import { FluidSmoothPass } from "./fluid_smooth_pass";
import { FluidSurfacePass } from "./fluid_surface_pass";
import { FluidThicknessPass } from "./fluid_thickness_pass";
import { FluidTilesPass } from "./fluid_tiles_pass";
import type { FluidQuality } from "./quality";
import type { Sky } from "./sky";
import { viewRay } from "./view_ray";
import type { BehindTextures } from "./water_body";

/** A tank of particles absorbs light as if it had this side, because small ones would look like glass. */
const kColourSideM = 6;

export class Fluid {
  private readonly particles: FluidParticles;
  private readonly tiles: FluidTilesPass;
  private readonly depth: FluidDepthPass;
  private readonly smooth: FluidSmoothPass;
  private readonly normal: FluidNormalPass;
  private readonly thickness: FluidThicknessPass;
  private readonly surface: FluidSurfacePass;
  /** Undefined over a wave, which has no floor of its own. */
  private readonly shadow: FluidShadowPass | undefined;
  private readonly size = new Vector2();
  private readonly ray = new Vector4();

  /** `field` undefined: no wave around the particles. */
  constructor(sky: Sky, noise: Texture, field: Texture | undefined, sideM: number, private readonly quality: FluidQuality) {
    this.particles = new FluidParticles(field, sideM);
    const colourRatio = field ? 1 : Math.max(kColourSideM / sideM, 1);
    this.tiles = new FluidTilesPass(this.particles);
    this.depth = new FluidDepthPass(this.particles);
    this.smooth = new FluidSmoothPass(this.tiles, quality.samplesCount, quality.roundsCount);
    this.normal = new FluidNormalPass(this.tiles);
    this.thickness = new FluidThicknessPass(this.particles);
    this.surface = new FluidSurfacePass(this.tiles, sky, noise, this.particles.uniforms, field !== undefined, colourRatio);
    if (!field) this.shadow = new FluidShadowPass(this.particles, sky, sideM, colourRatio);
  }

  /** Shows `frame`, extrapolated by its velocities for `advanceS` seconds. */
  show(frame: ParticleFrame, advanceS: number): void {
    this.particles.show(frame, advanceS);
  }

  /** Shades the floor in the target of the solids; `floorM`: its height. */
  renderShadow(renderer: WebGLRenderer, camera: PerspectiveCamera, solids: WebGLRenderTarget, floorM: number): void {
    const { frame } = this.particles;
    if (frame && frame.count > 0) this.shadow?.render(renderer, camera, solids, floorM, frame.radiusM);
  }

  /** Draws the fluid over the picture on the canvas. `behind`: the solids. */
  render(renderer: WebGLRenderer, camera: PerspectiveCamera, behind: BehindTextures): void {
    const { frame } = this.particles;
    if (!frame || frame.count === 0) return;
    this.resize(renderer);
    const ray = viewRay(camera, this.ray);
    this.tiles.mark(renderer, camera, this.particles);
    this.depth.render(renderer, camera);
    const front = this.smooth.render(renderer, camera, this.depth.target.texture, frame.radiusM);
    this.normal.render(renderer, front, ray);
    this.thickness.render(renderer, camera);
    const textures = { front, normals: this.normal.target.texture, thickness: this.thickness.target.texture };
    this.surface.render(renderer, camera, textures, behind, ray);
  }

  dispose(): void {
    for (const part of [this.particles, this.tiles, this.depth, this.smooth, this.normal, this.thickness, this.surface, this.shadow]) part?.dispose();
  }

  private resize(renderer: WebGLRenderer): void {
    renderer.getDrawingBufferSize(this.size).multiplyScalar(this.quality.scale).ceil();
    for (const pass of [this.depth, this.smooth, this.normal, this.thickness]) pass.resize(this.size.x, this.size.y);
  }
}

// Draws what flies apart from the liquid as drops, over the picture. Reads the particles, the volume, the solids' depth and the canvas.
// Writes the canvas.
import { NormalBlending, Vector2, type Matrix4, type RawShaderMaterial, type Texture } from "three";

import type { Pass, Picture } from "../drawing/pass";
import type { Sky } from "../light/sky";
import { makeMaterial } from "../shaders/materials";
import type { SolidsPass } from "../solids/solids_pass";
import type { FluidParticles } from "./fluid_particles";
import type { FluidVolumePass } from "./fluid_volume_pass";

export class FluidDropsPass implements Pass {
  readonly name = "fluid drops";
  readonly reads = ["particles", "fluidVolume", "froth", "solids", "canvas"] as const;
  readonly writes = ["canvas"] as const;
  private readonly material: RawShaderMaterial;

  /**
   * `volume` undefined: all particles over the wave are drops. `isOverWave`: they are not in a tank. `dropsCount`: drawn for each particle.
   * `froth`: foam and shade of hulls, beside which drops are not drawn.
   */
  constructor(
    private readonly particles: FluidParticles,
    volume: FluidVolumePass | undefined,
    solids: SolidsPass,
    sky: Sky,
    noise: Texture,
    private readonly dropsCount: number,
    isOverWave: boolean,
    froth?: Texture,
  ) {
    const own = { u_target_px: { value: new Vector2(1, 1) }, u_drop: { value: 0 }, u_camera_world: { value: null }, u_behind_depth: { value: solids.textures.depth }, u_froth: { value: froth }, u_noise: { value: noise } };
    const uniforms = { ...sky.uniforms, ...particles.uniforms, ...volume?.uniforms, ...own };
    const blended = { blending: NormalBlending, transparent: true, depthWrite: false };
    this.material = makeMaterial(isOverWave ? "fluidSpray" : "fluidDrop", uniforms, { defines: { ...(volume && { VOLUME: 1 }), ...(froth && { FROTH: 1 }) }, ...blended });
  }

  draw({ renderer, camera, sizePx }: Picture): void {
    if (this.particles.isEmpty) return;
    const { uniforms } = this.material;
    (uniforms["u_target_px"]!.value as Vector2).copy(sizePx);
    uniforms["u_camera_world"]!.value = camera.matrixWorld satisfies Matrix4;
    for (let drop = 0; drop < this.dropsCount; ++drop) {
      uniforms["u_drop"]!.value = drop;
      this.material.uniformsNeedUpdate = true;
      this.particles.renderOver(renderer, camera, this.material, null);
    }
  }

  dispose(): void {
    this.material.dispose();
  }
}

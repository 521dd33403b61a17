// Particles as spheres, in the colours of a value or with Phong's lighting (look_particle.frag). Reads the particles, the depth of the
// solids and of the surface. Writes the canvas and its depth.
import { Matrix3, Vector2, type RawShaderMaterial } from "three";

import type { Pass, Picture } from "../drawing/pass";
import type { FluidParticles } from "../fluid/fluid_particles";
import type { Sky } from "../light/sky";
import { makeMaterial } from "../shaders/materials";
import type { SolidsPass } from "../solids/solids_pass";
import type { LookColours } from "./look_colours";

export class LookParticlesPass implements Pass {
  readonly name = "look particles";
  readonly reads = ["particles", "solids", "canvas"] as const;
  readonly writes = ["canvas"] as const;
  private readonly material: RawShaderMaterial;

  /** `colour` undefined: no value is shown. */
  constructor(
    private readonly particles: FluidParticles,
    solids: SolidsPass,
    sky: Sky,
    colour?: { of: "speed" | "density"; colours: LookColours },
  ) {
    const uniforms = {
      ...sky.uniforms,
      ...particles.uniforms,
      ...colour?.colours.uniforms,
      u_target_px: { value: new Vector2(1, 1) },
      u_camera_world: { value: new Matrix3() },
      u_behind_depth: { value: solids.textures.depth },
    };
    this.material = makeMaterial("lookParticle", uniforms, { defines: colour ? { [colour.of === "speed" ? "OF_SPEED" : "OF_DENSITY"]: 1 } : {} });
  }

  draw({ renderer, camera, sizePx }: Picture): void {
    if (this.particles.isEmpty) return;
    const { uniforms } = this.material;
    (uniforms["u_target_px"]!.value as Vector2).copy(sizePx);
    (uniforms["u_camera_world"]!.value as Matrix3).setFromMatrix4(camera.matrixWorld);
    this.particles.renderOver(renderer, camera, this.material, null);
  }

  dispose(): void {
    this.material.dispose();
  }
}

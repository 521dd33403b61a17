// Shades the floor under a tank of particles. Reads the particles and the depth of the solids. Writes the colour of the solids.
import { BufferAttribute, BufferGeometry, DstColorFactor, CustomBlending, Mesh, Scene, Vector2, ZeroFactor, type RawShaderMaterial } from "three";

import type { Pass, Picture } from "../drawing/pass";
import type { Sky } from "../light/sky";
import { makeMaterial } from "../shaders/materials";
import type { SolidsPass } from "../solids/solids_pass";
import type { FluidParticles } from "./fluid_particles";
import { makeHalfTarget, thicknessBlending } from "./fluid_targets";

const kTargetPx = 256;
/** The floor that is shaded, in sides of the tank. */
const kShadedSides = 2;
/** Distance between samples in particle radii. */
const kApartRadii = 4;

export class FluidShadowPass implements Pass {
  readonly name = "fluid shadow";
  readonly reads = ["particles", "solids"] as const;
  readonly writes = ["solids"] as const;
  private readonly target = makeHalfTarget();
  private readonly along: RawShaderMaterial;
  private readonly scene = new Scene();
  private readonly floor: Mesh<BufferGeometry, RawShaderMaterial>;

  constructor(
    private readonly particles: FluidParticles,
    private readonly solids: SolidsPass,
    sky: Sky,
    sideM: number,
    colourRatio: number,
  ) {
    this.target.setSize(kTargetPx, kTargetPx);
    const place = { u_floor_m: { value: 0 }, u_shaded_m: { value: kShadedSides * sideM } };
    const sunlit = { ...particles.uniforms, ...sky.uniforms, ...place, u_target_px: { value: new Vector2(kTargetPx, kTargetPx) } };
    this.along = makeMaterial("fluidThickness", sunlit, { defines: { SHADOW: 1 }, ...thicknessBlending });
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array([-0.5, 0, -0.5, -0.5, 0, 0.5, 0.5, 0, -0.5, 0.5, 0, 0.5]), 3));
    geometry.setIndex([0, 1, 2, 2, 1, 3]);
    const uniforms = { ...place, u_thickness: { value: this.target.texture }, u_apart_m: { value: 1 }, u_colour_ratio: { value: colourRatio } };
    this.floor = new Mesh(
      geometry,
      makeMaterial("fluidShadow", uniforms, {
        blending: CustomBlending,
        blendSrc: DstColorFactor,
        blendDst: ZeroFactor,
        transparent: true,
        depthWrite: false,
        polygonOffset: true,
        polygonOffsetFactor: -2,
        polygonOffsetUnits: -4,
      }),
    );
    this.floor.frustumCulled = false;
    this.scene.add(this.floor);
  }

  draw({ renderer, camera }: Picture): void {
    if (this.particles.isEmpty) return;
    const { uniforms } = this.floor.material;
    uniforms["u_floor_m"]!.value = this.solids.surroundings.floorM;
    uniforms["u_apart_m"]!.value = kApartRadii * this.particles.radiusM;
    this.particles.render(renderer, camera, this.along, this.target);
    renderer.setRenderTarget(this.solids.target);
    renderer.render(this.scene, camera);
  }

  dispose(): void {
    this.target.dispose();
    this.along.dispose();
    this.floor.geometry.dispose();
    this.floor.material.dispose();
  }
}

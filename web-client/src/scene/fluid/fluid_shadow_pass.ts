// Shades the floor under a tank of particles. Reads the volume and the depth of the solids. Writes the colour of the solids.
import { BufferAttribute, BufferGeometry, CustomBlending, DstColorFactor, HalfFloatType, Mesh, RedFormat, Scene, WebGLRenderTarget, ZeroFactor, type RawShaderMaterial } from "three";

import { FullscreenPass } from "../drawing/fullscreen";
import type { Pass, Picture } from "../drawing/pass";
import type { Sky } from "../light/sky";
import { makeMaterial } from "../shaders/materials";
import type { SolidsPass } from "../solids/solids_pass";
import type { FluidParticles } from "./fluid_particles";
import type { FluidVolumePass } from "./fluid_volume_pass";

const kTargetPx = 160;
/** The floor that is shaded, in sides of the tank. */
const kShadedSides = 2;
/** Distance between samples in particle radii. */
const kApartRadii = 4;

export class FluidShadowPass implements Pass {
  readonly name = "fluid shadow";
  readonly reads = ["fluidVolume", "solids"] as const;
  readonly writes = ["solids"] as const;
  private readonly target = new WebGLRenderTarget(kTargetPx, kTargetPx, { format: RedFormat, type: HalfFloatType, depthBuffer: false });
  private readonly column: FullscreenPass;
  private readonly scene = new Scene();
  private readonly floor: Mesh<BufferGeometry, RawShaderMaterial>;

  constructor(
    private readonly particles: FluidParticles,
    volume: FluidVolumePass,
    private readonly solids: SolidsPass,
    sky: Sky,
    sideM: number,
    colourRatio: number,
  ) {
    const place = { u_floor_m: { value: 0 }, u_shaded_m: { value: kShadedSides * sideM } };
    this.column = new FullscreenPass(makeMaterial("fluidColumn", { ...volume.uniforms, ...sky.uniforms, ...place }, { depthTest: false, depthWrite: false }));
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
    this.column.render(renderer, this.target);
    renderer.setRenderTarget(this.solids.target);
    renderer.render(this.scene, camera);
  }

  dispose(): void {
    this.target.dispose();
    this.column.dispose();
    this.floor.geometry.dispose();
    this.floor.material.dispose();
  }
}

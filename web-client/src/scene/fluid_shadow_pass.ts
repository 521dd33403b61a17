// Shades the floor under a tank of particles. Reads the particles. Writes the colour of the solids' target.
import { BufferAttribute, BufferGeometry, DstColorFactor, CustomBlending, Mesh, Scene, Vector2, ZeroFactor, type PerspectiveCamera, type RawShaderMaterial, type WebGLRenderer, type WebGLRenderTarget } from "three";

import type { FluidParticles } from "./fluid_particles";
import { makeHalfTarget, thicknessBlending } from "./fluid_targets";
import { makeMaterial } from "./shaders";
import type { Sky } from "./sky";

const kTargetPx = 256;
/** The floor that is shaded, in sides of the tank. */
const kShadedSides = 2;
/** Distance between samples in particle radii. */
const kApartRadii = 4;

export class FluidShadowPass {
  private readonly target = makeHalfTarget();
  private readonly along: RawShaderMaterial;
  private readonly scene = new Scene();
  private readonly floor: Mesh<BufferGeometry, RawShaderMaterial>;

  constructor(private readonly particles: FluidParticles, sky: Sky, sideM: number, colourRatio: number) {
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

  /** `floorM`: height of the floor in `solids`. */
  render(renderer: WebGLRenderer, camera: PerspectiveCamera, solids: WebGLRenderTarget, floorM: number, radiusM: number): void {
    const { uniforms } = this.floor.material;
    uniforms["u_floor_m"]!.value = floorM;
    uniforms["u_apart_m"]!.value = kApartRadii * radiusM;
    this.particles.render(renderer, camera, this.along, this.target);
    renderer.setRenderTarget(solids);
    renderer.render(this.scene, camera);
  }

  dispose(): void {
    this.target.dispose();
    this.along.dispose();
    this.floor.geometry.dispose();
    this.floor.material.dispose();
  }
}

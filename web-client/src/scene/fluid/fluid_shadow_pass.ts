// Shades the floor under a tank of particles, and draws a map of the floor for the rays that reach it through the water. Reads the volume and
// the depth of the solids. Writes the colour of the solids, and the map.
import { BufferAttribute, BufferGeometry, HalfFloatType, LinearFilter, LinearMipmapLinearFilter, Mesh, OrthographicCamera, RedFormat, Scene, Vector2, WebGLRenderTarget, type Camera, type RawShaderMaterial, type WebGLRenderer } from "three";

import type { GreetingInfo } from "../../../client/codec/greeting";
import { FullscreenPass } from "../drawing/fullscreen";
import type { Pass, Picture } from "../drawing/pass";
import type { FluidQuality, Quality } from "../drawing/quality";
import type { Sky } from "../light/sky";
import { colourRatio } from "../light/water_optics";
import { kDarkening, makeMaterial, type Uniforms } from "../shaders/materials";
import type { SolidsPass } from "../solids/solids_pass";
import type { FluidParticles } from "./fluid_particles";
import type { FluidVolumePass } from "./fluid_volume_pass";

const kTargetPx = 160;
/** Texels along the map of a pool's floor over those of a tank's, whose tiles are fewer. */
const kTankTexelsRatio = 2;
/** The camera of the map looks down from this share of the tank's length over the floor. */
const kMapAboveSides = 0.25;
/** Distance between samples in particle radii. */
const kApartRadii = 4;

export class FluidShadowPass implements Pass {
  readonly name = "fluid shadow";
  readonly reads = ["fluidVolume", "solids"] as const;
  readonly writes = ["solids", "fluidFloor"] as const;
  /** For the shader that looks at the floor through the water. */
  readonly uniforms: Uniforms;
  private readonly map: WebGLRenderTarget;
  private readonly above: OrthographicCamera;
  private readonly target = new WebGLRenderTarget(kTargetPx, kTargetPx, { format: RedFormat, type: HalfFloatType, depthBuffer: false });
  private readonly column: FullscreenPass;
  private readonly scene = new Scene();
  private readonly floor: Mesh<BufferGeometry, RawShaderMaterial>;

  constructor(
    private readonly particles: FluidParticles,
    volume: FluidVolumePass,
    private readonly solids: SolidsPass,
    sky: Sky,
    greeting: GreetingInfo,
    { floorTexelsCount, texelType, plain }: Pick<FluidQuality, "floorTexelsCount"> & Pick<Quality, "texelType" | "plain">,
  ) {
    const { sideM, widthM } = greeting;
    const sideTexelsCount = solids.surroundings.edge.kind === "walls" ? floorTexelsCount : floorTexelsCount / kTankTexelsRatio;
    this.map = new WebGLRenderTarget(sideTexelsCount, sideTexelsCount, { type: texelType, generateMipmaps: !plain, minFilter: plain ? LinearFilter : LinearMipmapLinearFilter });
    this.above = new OrthographicCamera(-sideM / 2, sideM / 2, widthM / 2, -widthM / 2, 0, 2 * kMapAboveSides * sideM);
    this.above.up.set(0, 0, -1);
    this.uniforms = { u_floor_light: { value: this.map.texture }, u_floor_size_m: { value: new Vector2(sideM, widthM) } };
    const place = { u_floor_m: { value: 0 }, u_shaded_m: { value: Math.max(sideM, widthM) } };
    this.column = new FullscreenPass(makeMaterial("fluidColumn", { ...volume.uniforms, ...sky.uniforms, ...place }, { depthTest: false, depthWrite: false }));
    const geometry = new BufferGeometry();
    const [x, z] = [0.5 * sideM, 0.5 * widthM].map((half) => half / place.u_shaded_m.value) as [number, number];
    geometry.setAttribute("position", new BufferAttribute(new Float32Array([-x, 0, -z, -x, 0, z, x, 0, -z, x, 0, z]), 3));
    geometry.setIndex([0, 1, 2, 2, 1, 3]);
    const uniforms = { ...place, u_thickness: { value: this.target.texture }, u_apart_m: { value: 1 }, u_colour_ratio: { value: colourRatio(greeting) } };
    this.floor = new Mesh(geometry, makeMaterial("fluidShadow", uniforms, kDarkening));
    this.floor.frustumCulled = false;
    this.scene.add(this.floor);
  }

  draw({ renderer, camera }: Picture): void {
    if (this.particles.isEmpty) return;
    const { above, map } = this;
    const { floorM, solids } = this.solids.surroundings;
    const { uniforms } = this.floor.material;
    uniforms["u_floor_m"]!.value = floorM;
    uniforms["u_apart_m"]!.value = kApartRadii * this.particles.radiusM;
    this.column.render(renderer, this.target);
    above.position.set(0, floorM + above.far / 2, 0);
    above.lookAt(0, floorM, 0);
    renderer.setRenderTarget(map);
    renderer.clear();
    for (const solid of solids) renderer.render(solid, above);
    this.shade(renderer, above, map);
    this.shade(renderer, camera, this.solids.target);
  }

  private shade(renderer: WebGLRenderer, camera: Camera, target: WebGLRenderTarget): void {
    renderer.setRenderTarget(target);
    renderer.render(this.scene, camera);
  }

  dispose(): void {
    this.target.dispose();
    this.map.dispose();
    this.column.dispose();
    this.floor.geometry.dispose();
    this.floor.material.dispose();
  }
}

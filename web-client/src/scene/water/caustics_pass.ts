// Sunlight that the waves focus on what is below them: a grid of the surface is refracted along the light and drawn with the ratio of its
// areas, added up (after Stam 1996; Shah, Konttinen & Pattanaik 2007). Two layers: at the floor, and above it, because focus grows with the depth.
// Reads the field and the ripples. Writes the caustics: light relative to level water, over the square, mean 1.
import { AdditiveBlending, DoubleSide, HalfFloatType, LinearMipmapLinearFilter, Mesh, RGFormat, Scene, Vector2, Vector3, Camera, Color, WebGLRenderTarget, type BufferGeometry, type RawShaderMaterial, type Texture } from "three";

import type { Pass, Picture } from "../drawing/pass";
import type { Sky } from "../light/sky";
import { makeMaterial, type Uniforms } from "../shaders/materials";
import { gridLines, makeGrid } from "./water_grid";

/** The grid reaches beyond the square, in sides: light that comes in from beside it. */
const kReachSides = 1.12;
/** Layers: channel, and depth as a share of the floor's (kUpperLayer in caustics.glsl). */
const kLayers = [
  { channel: [1, 0], depths: 1 },
  { channel: [0, 1], depths: 0.4 },
];
/** Direct light below which the focus cannot be seen. */
const kLeastLight = 0.02;

export class CausticsPass implements Pass {
  readonly name = "caustics";
  readonly reads = ["field", "sea"] as const;
  readonly writes = ["caustics"] as const;
  /** Of caustics.glsl. */
  readonly uniforms: Uniforms;
  private readonly target: WebGLRenderTarget;
  private readonly scene = new Scene();
  private readonly camera = new Camera();
  private readonly mesh: Mesh<BufferGeometry, RawShaderMaterial>;
  private readonly white = new Color(1, 1, 1);
  private readonly cleared = new Color();

  /** `ripples`: of ripples.glsl; undefined: there are none. */
  constructor(field: Texture, ripples: Uniforms | undefined, private readonly sky: Sky, size: { sideM: number; widthM: number; depthM: number }, { cellsCount, texelsCount }: { cellsCount: number; texelsCount: number }) {
    const { sideM, widthM, depthM } = size;
    const extentM = new Vector2(sideM, widthM);
    this.target = new WebGLRenderTarget(texelsCount, texelsCount, {
      format: RGFormat,
      type: HalfFloatType,
      minFilter: LinearMipmapLinearFilter,
      generateMipmaps: true,
      depthBuffer: false,
    });
    this.uniforms = { u_caustics: { value: this.target.texture }, u_caustic_depth_m: { value: depthM }, u_caustic_extent_m: { value: extentM } };
    const lines = gridLines(cellsCount, false, false);
    const uniforms = {
      ...sky.uniforms,
      ...ripples,
      u_field: { value: field },
      u_extent_m: { value: extentM },
      u_deep_m: { value: depthM },
      u_reach: { value: kReachSides },
      u_layer: { value: new Vector2() },
      u_texel_m: { value: Math.sqrt((sideM / texelsCount) * (widthM / texelsCount)) },
    };
    this.mesh = new Mesh(makeGrid(lines, lines), makeMaterial("caustics", uniforms, { ...(ripples && { defines: { RIPPLES: 1 } }), side: DoubleSide, depthTest: false, depthWrite: false, transparent: true, blending: AdditiveBlending, premultipliedAlpha: true }));
    this.mesh.frustumCulled = false;
    this.scene.add(this.mesh);
  }

  draw({ renderer }: Picture): void {
    const { uniforms } = this.mesh.material;
    const light = this.sky.uniforms["u_sun_light"]!.value as Vector3;
    const isLit = Math.max(light.x, light.y, light.z) * (this.sky.uniforms["u_sun_sharp"]!.value as number) > kLeastLight;
    renderer.setRenderTarget(this.target);
    if (!isLit) {
      renderer.getClearColor(this.cleared);
      const alpha = renderer.getClearAlpha();
      renderer.setClearColor(this.white, 1);
      renderer.clear();
      renderer.setClearColor(this.cleared, alpha);
      return;
    }
    renderer.clear();
    for (const { channel, depths } of kLayers) {
      (uniforms["u_layer"]!.value as Vector2).fromArray(channel);
      uniforms["u_deep_m"]!.value = depths * (this.uniforms["u_caustic_depth_m"]!.value as number);
      this.mesh.material.uniformsNeedUpdate = true;
      renderer.render(this.scene, this.camera);
    }
  }

  dispose(): void {
    this.target.dispose();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

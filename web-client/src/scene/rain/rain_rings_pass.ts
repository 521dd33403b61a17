// Rings of the small drops of rain, as slopes in a tile that repeats over the water. Each drop of the tile falls again and again, elsewhere each
// time. Reads nothing but the time. Writes the rain.
import { BufferAttribute, BufferGeometry, HalfFloatType, LinearMipmapLinearFilter, Mesh, RepeatWrapping, RGFormat, Scene, WebGLRenderTarget, type RawShaderMaterial } from "three";

import type { GreetingInfo } from "../../../client/codec/greeting";
import type { Pass, Picture } from "../drawing/pass";
import { rainShare } from "../light/weather";
import { makeFastRandom } from "../maths/random";
import { kAdding, makeMaterial, type Uniforms } from "../shaders/materials";
import { makeDropSeeds } from "./drop_seeds";

const kTileM = 4;
/** Rings at a time in the hardest rain, per m^2. */
const kRingsPerM2 = 40;
/** Two triangles, and three copies of them for rings that cross the edge of the tile. */
const kVertices = 4 * 6;
const kSeed = 20_260_201;

export class RainRingsPass implements Pass {
  readonly name = "rain rings";
  readonly reads = [] as const;
  readonly writes = ["rain"] as const;
  /** For the shader of the water. */
  readonly uniforms: Uniforms;
  private readonly target: WebGLRenderTarget;
  private readonly scene = new Scene();
  private readonly rings: Mesh<BufferGeometry, RawShaderMaterial>;
  private readonly ringsCount = Math.round(kRingsPerM2 * kTileM * kTileM);
  private readonly share = { value: 0 };
  private isClear = false;

  /** `greeting` is read in every picture, because its wind changes. `texelsCount`: along each side of the tile. */
  constructor(
    private readonly greeting: GreetingInfo,
    texelsCount: number,
  ) {
    this.target = new WebGLRenderTarget(texelsCount, texelsCount, {
      format: RGFormat,
      type: HalfFloatType,
      minFilter: LinearMipmapLinearFilter,
      wrapS: RepeatWrapping,
      wrapT: RepeatWrapping,
      generateMipmaps: true,
      depthBuffer: false,
    });
    this.uniforms = { u_rain: { value: this.target.texture }, u_rain_tile_m: { value: kTileM }, u_rain_share: this.share };
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(makeDropSeeds(this.ringsCount, kVertices, makeFastRandom(kSeed)), 4));
    const material = makeMaterial("rainRing", { u_time_s: { value: 0 }, u_tile_m: { value: kTileM } }, kAdding);
    this.rings = new Mesh(geometry, material);
    this.rings.frustumCulled = false;
    this.scene.add(this.rings);
  }

  draw({ renderer, camera, shownS }: Picture): void {
    this.share.value = shownS === undefined ? 0 : rainShare(this.greeting.wind);
    if (this.share.value === 0 && this.isClear) return;
    this.isClear = this.share.value === 0;
    this.rings.material.uniforms["u_time_s"]!.value = shownS ?? 0;
    this.rings.geometry.setDrawRange(0, Math.round(this.share.value * this.ringsCount) * kVertices);
    renderer.setRenderTarget(this.target);
    renderer.clear();
    renderer.render(this.scene, camera);
  }

  dispose(): void {
    this.target.dispose();
    this.rings.geometry.dispose();
    this.rings.material.dispose();
  }
}

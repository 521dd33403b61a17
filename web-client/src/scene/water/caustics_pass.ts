// Sunlight that the waves focus on what is below them: a grid of the surface is refracted along the light and drawn with the ratio of its
// areas, added up (after Stam 1996; Shah, Konttinen & Pattanaik 2007). Two layers: at the floor, and above it, because focus grows with the depth.
// The grid is too coarse for the ripples of a pool: their light has a repeating tile of its own, as their waves have.
// Reads the field and the ripples. Writes the caustics: light relative to level water, over the square and over the tile, mean 1.
import { AdditiveBlending, DoubleSide, HalfFloatType, LinearMipmapLinearFilter, Mesh, RGFormat, RepeatWrapping, Scene, Vector2, Vector3, Camera, Color, WebGLRenderTarget, type BufferGeometry, type RawShaderMaterial, type Texture } from "three";

import type { Pass, Picture } from "../drawing/pass";
import type { Sky } from "../light/sky";
import type { OpenSea } from "../sea/open_sea";
import { makeMaterial, type Uniforms } from "../shaders/materials";
import { cellsAlong, gridLines, makeGrid } from "./water_grid";

/** The grid reaches beyond the square, in sides: light that comes in from beside it. */
const kReachSides = 1.12;
/** Layers: channel, and depth as a share of the floor's (kUpperLayer in caustics.glsl). */
const kLayers = [
  { channel: [1, 0], depths: 1 },
  { channel: [0, 1], depths: 0.4 },
];
/**
 * Root mean square of the convergence of a pool's light at the floor by ripples: below 0.5 the light does not come to a point, above 1 its
 * lines cross each other. The ripples drawn are calmer, because a mirror that stirred would not show the garden.
 */
const kRippleFocus = 0.65;
/** Light is focused in shallow water by shorter ripples: the longest are at most as long as the depth over this. */
const kDepthPerRipple = 2;
/** Share of a slope by which light turns that enters water. */
const kTurn = 0.25;
/** Texels of the ripples' tile over those of the square: triangles have edges, which its next mip level smooths (caustics.glsl). */
const kTileTexels = 2;
/** Direct light below which the focus cannot be seen. */
const kLeastLight = 0.02;

interface Water {
  sideM: number;
  widthM: number;
  depthM: number;
  isPool: boolean;
}

export class CausticsPass implements Pass {
  readonly name = "caustics";
  readonly reads = ["field", "sea"] as const;
  readonly writes = ["caustics"] as const;
  /** Of caustics.glsl. */
  readonly uniforms: Uniforms;
  private readonly target: WebGLRenderTarget;
  private readonly tile: WebGLRenderTarget;
  private readonly camera = new Camera();
  private readonly layers: Scene[];
  private readonly ripples: Scene | undefined;
  private readonly geometry: BufferGeometry;
  private readonly materials: RawShaderMaterial[] = [];
  private readonly white = new Color(1, 1, 1);
  private readonly cleared = new Color();

  /** `field` undefined: there are ripples alone. */
  constructor(field: Texture | undefined, sea: OpenSea | undefined, private readonly sky: Sky, { sideM, widthM, depthM, isPool }: Water, { cellsCount, texelsCount }: { cellsCount: number; texelsCount: number }) {
    const extentM = new Vector2(sideM, widthM);
    const shrunk = sea ? Math.min(depthM / (kDepthPerRipple * sea.longestRippleM), 1) : 1;
    const tileM = shrunk * ((sea?.uniforms["u_tiles_m"]!.value as Vector2 | undefined)?.y ?? 1);
    const makeTarget = (xCount: number, zCount: number): WebGLRenderTarget =>
      new WebGLRenderTarget(xCount, zCount, { format: RGFormat, type: HalfFloatType, minFilter: LinearMipmapLinearFilter, wrapS: RepeatWrapping, wrapT: RepeatWrapping, generateMipmaps: true, depthBuffer: false });
    const size = { sideM, widthM };
    const tileTexels = isPool ? kTileTexels * texelsCount : 1;
    this.target = field ? makeTarget(...cellsAlong(texelsCount, size)) : makeTarget(1, 1);
    this.tile = makeTarget(tileTexels, tileTexels);
    this.uniforms = {
      u_caustics: { value: this.target.texture },
      u_caustic_depth_m: { value: depthM },
      u_caustic_extent_m: { value: extentM },
      u_caustic_ripples: { value: this.tile.texture },
      u_caustic_tile_m: { value: tileM },
    };
    const [lines, across] = cellsAlong(cellsCount, size).map((count) => gridLines(count, false, false));
    this.geometry = makeGrid(lines!, across!);
    const makeScene = (defines: Record<string, number>, overM: Vector2, deepM: number, channel: readonly number[], texels = texelsCount, gain = 1): Scene => {
      const uniforms = {
        ...sky.uniforms,
        ...sea?.uniforms,
        u_field: { value: field ?? null },
        u_extent_m: { value: overM },
        u_deep_m: { value: deepM },
        u_reach: { value: kReachSides },
        u_gain: { value: gain },
        u_layer: { value: new Vector2().fromArray(channel) },
        u_texel_m: { value: Math.sqrt(overM.x * overM.y) / texels },
      };
      const material = makeMaterial("caustics", uniforms, { defines, side: DoubleSide, depthTest: false, depthWrite: false, transparent: true, blending: AdditiveBlending, premultipliedAlpha: true });
      this.materials.push(material);
      const mesh = new Mesh(this.geometry, material);
      mesh.frustumCulled = false;
      return new Scene().add(mesh);
    };
    this.layers = field ? kLayers.map(({ channel, depths }) => makeScene(sea && !isPool ? { RIPPLES: 1 } : {}, extentM, depths * depthM, channel)) : [];
    if (isPool && sea) this.ripples = makeScene({ RIPPLES: 1, TILE: 1 }, new Vector2(tileM, tileM), depthM, [1, 1], kTileTexels * texelsCount, (kRippleFocus * shrunk) / (kTurn * depthM * sea.rippleCurvaturePerM));
  }

  draw({ renderer }: Picture): void {
    const light = this.sky.uniforms["u_sun_light"]!.value as Vector3;
    const isLit = Math.max(light.x, light.y, light.z) * (this.sky.uniforms["u_sun_sharp"]!.value as number) > kLeastLight;
    renderer.getClearColor(this.cleared);
    const alpha = renderer.getClearAlpha();
    const focus = (target: WebGLRenderTarget, scenes: readonly Scene[]): void => {
      renderer.setRenderTarget(target);
      if (!isLit || scenes.length === 0) renderer.setClearColor(this.white, 1);
      renderer.clear();
      renderer.setClearColor(this.cleared, alpha);
      if (isLit) for (const scene of scenes) renderer.render(scene, this.camera);
    };
    focus(this.target, this.layers);
    focus(this.tile, this.ripples ? [this.ripples] : []);
  }

  dispose(): void {
    for (const each of [this.target, this.tile, this.geometry, ...this.materials]) each.dispose();
  }
}

// The sky: baked into a cube map that the dome, the water's reflection and the particles' gloss read, and the light of the
// hour and the weather (light/light.ts) as uniforms of every material. A new light shows at once in the uniforms; the cube map follows a
// few times per second.
import {
  BackSide,
  BoxGeometry,
  type BufferGeometry,
  CubeCamera,
  LinearFilter,
  LinearMipmapLinearFilter,
  Matrix4,
  PlaneGeometry,
  Mesh,
  Scene,
  Vector3,
  WebGLCubeRenderTarget,
  type PerspectiveCamera,
  type RawShaderMaterial,
  type WebGLRenderer,
} from "three";

import type { WaterTypeName } from "../../../client/codec/scene_info";
import { makeFullscreenGeometry } from "../drawing/fullscreen";
import type { Quality } from "../drawing/quality";
import { makeMaterial, type Uniforms } from "../shaders/materials";
import { derive, displayed, lightAt, type Light, type Rgb } from "./light";
import { waterOpticsOf } from "./water_optics";

const kFaceCount = 512;
/** Cells of the dome in the plain tiers, whose light is that of their corners. */
const kPlainColumns = 40;
const kPlainRows = 30;
/** Height of the lowest direction in which the sky is seen over a horizon of land or sea. */
const kLowestShown = -0.03;
/** Least time between two bakes: six faces cost a software renderer more than a picture. */
const kRebakeS = 0.25;

const vector = (): { value: Vector3 } => ({ value: new Vector3() });

export class Sky {
  /** Unit vector toward what gives the direct light. */
  readonly sunDirection = new Vector3();
  /** For every material that is lit or reflects the sky. */
  readonly uniforms: Uniforms;
  readonly dome: Mesh<BufferGeometry, RawShaderMaterial>;
  private readonly cube: WebGLCubeRenderTarget;
  private readonly domeUniforms: Uniforms;
  private readonly bakeUniforms: Uniforms;
  private readonly box: Mesh<BoxGeometry, RawShaderMaterial>;
  private readonly scene = new Scene();
  private isStale = true;
  private bakedS = Number.NEGATIVE_INFINITY;

  /** Plain: without mip levels, which prevent flicker in distant reflections but are too slow for software renderers. */
  constructor({ plain, texelType }: Pick<Quality, "plain" | "texelType">) {
    const smooth = !plain;
    this.cube = new WebGLCubeRenderTarget(smooth ? kFaceCount : kFaceCount / 4, {
      type: texelType,
      generateMipmaps: smooth,
      minFilter: smooth ? LinearMipmapLinearFilter : LinearFilter,
      magFilter: LinearFilter,
    });
    this.uniforms = {
      u_sky: { value: this.cube.texture },
      u_sun_direction: { value: this.sunDirection },
      u_sun_light: vector(),
      u_sun_below: vector(),
      u_ambient_up: vector(),
      u_ambient_down: vector(),
      u_water_light: vector(),
      u_glow: vector(),
      u_veiled_sky: { value: [new Vector3(), new Vector3(), new Vector3()] },
      u_sun_sharp: { value: 1 },
      u_exposure: { value: 1 },
      u_is_displayed: { value: false },
      u_displayed_sky: { value: [new Vector3(), new Vector3(), new Vector3()] },
      u_displayed_sun: vector(),
      u_displayed_glow: vector(),
      u_displayed_foam: vector(),
      u_loss_per_m: vector(),
      u_scattered: vector(),
      u_bubbly: vector(),
      u_crest: vector(),
    };
    this.bakeUniforms = {
      u_sun_direction: vector(),
      u_moon_direction: { value: this.sunDirection },
      u_zenith: vector(),
      u_middle: vector(),
      u_horizon: vector(),
      u_glow: this.uniforms["u_glow"]!,
      u_halo: vector(),
      u_cloud: vector(),
      u_cloud_lit: vector(),
      u_cloud_cover: { value: 0 },
      u_ambient_up: this.uniforms["u_ambient_up"]!,
      u_lowest: { value: -1 },
    };
    this.box = new Mesh(new BoxGeometry(2, 2, 2), makeMaterial("skyBake", this.bakeUniforms, { side: BackSide, defines: plain ? { PLAIN: 1 } : {} }));
    this.scene.add(this.box);
    this.domeUniforms = {
      ...this.uniforms,
      u_inverse_projection: { value: new Matrix4() },
      u_camera_world: { value: new Matrix4() },
      u_stars: { value: 0 },
      u_lowest: this.bakeUniforms["u_lowest"]!,
    };
    this.dome = new Mesh(plain ? new PlaneGeometry(2, 2, kPlainColumns, kPlainRows) : makeFullscreenGeometry(), makeMaterial(plain ? "skyPlain" : "skyDome", this.domeUniforms, { depthWrite: false }));
    this.dome.frustumCulled = false;
    // After the solids: only the remaining pixels are shaded.
    this.dome.renderOrder = 10;
    this.setLight(lightAt(12, 0));
  }

  /** Takes the colours of the scene's water; needed again after the WebGL context was restored, with which the cube map is lost. */
  enter(waterType: WaterTypeName): void {
    const { lossPerM, scattered, bubbly, crest } = waterOpticsOf(waterType);
    Object.entries({ u_loss_per_m: lossPerM, u_scattered: scattered, u_bubbly: bubbly, u_crest: crest }).forEach(([name, rgb]) => (this.uniforms[name]!.value as Vector3).set(...rgb));
    this.bakedS = Number.NEGATIVE_INFINITY;
    this.isStale = true;
  }

  setLight(light: Light): void {
    const { veiled, water, keyBelow } = derive(light);
    const set = (uniforms: Uniforms, name: string, rgb: Rgb): void => void (uniforms[name]!.value as Vector3).set(...rgb);
    this.sunDirection.set(...light.keyDirection);
    set(this.uniforms, "u_sun_light", light.key);
    set(this.uniforms, "u_sun_below", keyBelow);
    set(this.uniforms, "u_ambient_up", light.ambientUp);
    set(this.uniforms, "u_ambient_down", light.ambientDown);
    set(this.uniforms, "u_water_light", water);
    set(this.uniforms, "u_glow", light.glow);
    veiled.forEach((rgb, i) => (this.uniforms["u_veiled_sky"]!.value as Vector3[])[i]!.set(...rgb));
    this.uniforms["u_exposure"]!.value = light.exposure;
    this.setDisplayed(light, veiled);
    set(this.bakeUniforms, "u_sun_direction", light.sunDirection);
    set(this.bakeUniforms, "u_zenith", light.zenith);
    set(this.bakeUniforms, "u_middle", light.middle);
    set(this.bakeUniforms, "u_horizon", light.horizon);
    set(this.bakeUniforms, "u_halo", light.halo);
    set(this.bakeUniforms, "u_cloud", light.cloud);
    set(this.bakeUniforms, "u_cloud_lit", light.cloudLit);
    this.bakeUniforms["u_cloud_cover"]!.value = light.cloudCover;
    this.uniforms["u_sun_sharp"]!.value = light.sharp;
    this.domeUniforms["u_stars"]!.value = light.stars;
    this.isStale = true;
  }

  /** Sets what plain water mixes: colours for the display. */
  private setDisplayed({ key, glow, ambientUp, exposure, sharp }: Light, veiled: readonly Rgb[]): void {
    const { u_displayed_sky, u_displayed_sun, u_displayed_glow, u_displayed_foam } = this.uniforms;
    const shown = (of: (channel: 0 | 1 | 2) => number): Rgb => displayed({ x: of(0), y: of(1), z: of(2) }, exposure);
    veiled.forEach((rgb, i) => (u_displayed_sky!.value as Vector3[])[i]!.set(...shown((k) => rgb[k])));
    (u_displayed_sun!.value as Vector3).set(...shown((k) => key[k])).multiplyScalar(sharp);
    (u_displayed_glow!.value as Vector3).set(...shown((k) => veiled[2]![k] + 0.08 * glow[k])).sub((u_displayed_sky!.value as Vector3[])[2]!);
    (u_displayed_foam!.value as Vector3).set(...shown((k) => 0.94 * (0.9 * key[k] * Math.max(this.sunDirection.y, 0) + ambientUp[k])));
  }

  /** Bakes the cube map if the light has changed, at most once per kRebakeS. */
  update(renderer: WebGLRenderer, nowS: number): void {
    if (!this.isStale || nowS - this.bakedS < kRebakeS) return;
    this.isStale = false;
    this.bakedS = nowS;
    new CubeCamera(0.1, 10, this.cube).update(renderer, this.scene);
  }

  /** `hasHorizon`: something hides the lower half of the dome, so that it need not be shaded. */
  hideBelowHorizon(hasHorizon: boolean): void {
    this.domeUniforms["u_lowest"]!.value = hasHorizon ? kLowestShown : -1;
  }

  follow(camera: PerspectiveCamera): void {
    (this.domeUniforms["u_inverse_projection"]!.value as Matrix4).copy(camera.projectionMatrixInverse);
    (this.domeUniforms["u_camera_world"]!.value as Matrix4).copy(camera.matrixWorld);
  }

  dispose(): void {
    this.cube.dispose();
    this.box.geometry.dispose();
    this.box.material.dispose();
    this.dome.geometry.dispose();
    (this.dome.material as { dispose(): void }).dispose();
  }
}

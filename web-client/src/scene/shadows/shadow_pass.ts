// Depth of boats, buoys, objects, rocks, walls and stands as the sun or the moon sees them, from which solids and water tell whether they are in the
// shade (shadow.glsl). Reads the frames and the field, which move boats and buoys. Writes the shadow.
import { Camera, DepthTexture, DoubleSide, LessEqualCompare, LinearFilter, Matrix4, RedFormat, UnsignedIntType, Vector2, WebGLRenderTarget, type RawShaderMaterial, type Scene, type Texture, type Vector3 } from "three";

import type { GreetingInfo } from "../../../client/codec/greeting";
import type { Pass, Picture } from "../drawing/pass";
import { gardenReach } from "../landscape/garden";
import { bedOf } from "../landscape/terrain";
import type { Sky } from "../light/sky";
import { kCasterLayers } from "../meshes/casters";
import { makeMaterial, type Uniforms } from "../shaders/materials";
import { shadowMatrix, toClip, type ShadowBox } from "./shadow_frame";

/** Size of the box whose shadows are drawn, in sides of the square: half its length, with what stands around the water, and its height over the water. */
const kHalfSides: Record<Exclude<GreetingInfo["setting"], "pool">, number> = { openSea: 0.64, glassTank: 0.92, flume: 0.7 };
const kHighSides = 0.17;
/** The same of a pool's garden: distance from the water in those of its border, and height in those of its trees. */
const kGarden = { away: 1.5, high: 1.4 };
/** Direct light below which shadows cannot be seen. */
const kLeastLight = 0.02;

/** What casts shadows. */
export interface Casters {
  readonly scene: Scene;
  /** Moves them to where they are at a time of the scene. */
  place(shownS: number | undefined): void;
}

export class ShadowPass implements Pass {
  readonly name = "shadow";
  readonly reads = ["frames", "field"] as const;
  readonly writes = ["shadow"] as const;
  /** Of shadow.glsl. */
  readonly uniforms: Uniforms;
  private readonly target: WebGLRenderTarget;
  private readonly camera = new Camera();
  private readonly materials: Record<keyof typeof kCasterLayers, RawShaderMaterial>;
  private readonly box: ShadowBox;
  private readonly light: Vector3;
  private casters: Casters | undefined;

  /** `field` undefined: the room has no wave. */
  constructor(greeting: GreetingInfo, private readonly sky: Sky, field: Texture | undefined, texelsCount: number) {
    const { sideM, widthM } = greeting;
    const { depthM } = bedOf(greeting);
    const longM = Math.max(sideM, widthM);
    const { awayM, treeM } = gardenReach(longM);
    const [halfM, highM] = greeting.setting === "pool" ? [longM / 2 + kGarden.away * awayM, kGarden.high * treeM] : [kHalfSides[greeting.setting] * longM, kHighSides * longM];
    this.box = { halfM, lowM: -depthM, highM: (field ? 0 : depthM) + highM };
    this.light = sky.uniforms["u_sun_light"]!.value as Vector3;
    const depth = new DepthTexture(texelsCount, texelsCount, UnsignedIntType);
    depth.compareFunction = LessEqualCompare;
    depth.minFilter = depth.magFilter = LinearFilter;
    this.target = new WebGLRenderTarget(texelsCount, texelsCount, { format: RedFormat, depthTexture: depth });
    this.uniforms = { u_shadow: { value: depth }, u_shadow_matrix: { value: new Matrix4() }, u_shadow_texel_m: { value: new Vector2() } };
    const moved = { u_field: { value: field ?? null }, u_extent_m: { value: new Vector2(sideM, widthM) } };
    const parameters = { side: DoubleSide, colorWrite: false, polygonOffset: true, polygonOffsetFactor: 1.2, polygonOffsetUnits: 4 };
    this.materials = {
      solid: makeMaterial("shadow", moved, parameters),
      float: makeMaterial("shadow", moved, { ...parameters, defines: { FLOATS: 1 } }),
      instance: makeMaterial("shadow", moved, { ...parameters, defines: { INSTANCES: 1 } }),
    };
  }

  setCasters(casters: Casters): void {
    this.casters = casters;
  }

  draw({ renderer, shownS }: Picture): void {
    const { camera, casters, light, sky, target, uniforms } = this;
    renderer.setRenderTarget(target);
    renderer.clear();
    if (!casters || Math.max(light.x, light.y, light.z) * (sky.uniforms["u_sun_sharp"]!.value as number) < kLeastLight) return;
    casters.place(shownS);
    const toMap = shadowMatrix(this.box, sky.sunDirection);
    (uniforms["u_shadow_matrix"]!.value as Matrix4).copy(toMap);
    const { elements } = toMap;
    const perTexelM = (row: number): number => 1 / (Math.hypot(elements[row]!, elements[row + 4]!, elements[row + 8]!) * target.width);
    (uniforms["u_shadow_texel_m"]!.value as Vector2).set(perTexelM(0), perTexelM(1));
    // The whole transformation, so that three's culling sees the same box.
    camera.projectionMatrix.copy(toClip(toMap));
    for (const layer of ["solid", "float", "instance"] as const) {
      camera.layers.set(kCasterLayers[layer]);
      casters.scene.overrideMaterial = this.materials[layer];
      renderer.render(casters.scene, camera);
    }
    casters.scene.overrideMaterial = null;
  }

  dispose(): void {
    this.target.dispose();
    this.target.depthTexture?.dispose();
    for (const material of Object.values(this.materials)) material.dispose();
  }
}

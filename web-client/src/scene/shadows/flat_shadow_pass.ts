// Shadows on the water without a map of shadows: boats, objects, rocks and walls projected onto the still water, in the second channel of the froth,
// which the water reads anyway. Reads the solids as they were placed for this picture, and the froth. Writes the froth: 0 lit, above it the
// share of light that is missing.
import { Camera, DoubleSide, MaxEquation, type RawShaderMaterial, type Vector3, type WebGLRenderTarget } from "three";

import type { Pass, Picture } from "../drawing/pass";
import type { Sky } from "../light/sky";
import { kCasterLayers } from "../meshes/casters";
import { kAdding, makeMaterial } from "../shaders/materials";
import type { Casters } from "./shadow_pass";

/** Share of the water's light that is missing in the shade at noon. */
const kShade = 0.42;
/** Direct light at which half of that is missing. */
const kHalfLight = 0.12;

export class FlatShadowPass implements Pass {
  readonly name = "flat shadow";
  readonly reads = ["solids", "froth"] as const;
  readonly writes = ["froth"] as const;
  private readonly camera = new Camera();
  private readonly material: RawShaderMaterial;
  private readonly instances: RawShaderMaterial;
  private readonly light: Vector3;

  /** `target`: of the froth. */
  constructor(private readonly casters: Pick<Casters, "scene">, private readonly sky: Sky, private readonly target: WebGLRenderTarget, { sideM, widthM }: { sideM: number; widthM: number }) {
    this.light = sky.uniforms["u_sun_light"]!.value as Vector3;
    // Three's culling uses it, too, so that height needs a place in it.
    this.camera.projectionMatrix.set(2 / sideM, 0, 0, 0, 0, 0, 2 / widthM, 0, 0, 1e-3 / Math.max(sideM, widthM), 0, 0, 0, 0, 0, 1);
    const uniforms = { ...sky.uniforms, u_shade: { value: 0 } };
    const parameters = { ...kAdding, blendEquation: MaxEquation, side: DoubleSide } as const;
    this.material = makeMaterial("flatShadow", uniforms, parameters);
    this.instances = makeMaterial("flatShadow", uniforms, { ...parameters, defines: { INSTANCES: 1 } });
  }

  draw({ renderer }: Picture): void {
    const { camera, casters, instances, light, material, sky, target } = this;
    const directLight = Math.max(light.x, light.y, light.z) * (sky.uniforms["u_sun_sharp"]!.value as number);
    if (directLight < kHalfLight / 10) return;
    material.uniforms["u_shade"]!.value = (kShade * directLight) / (directLight + kHalfLight);
    renderer.setRenderTarget(target);
    casters.scene.overrideMaterial = material;
    camera.layers.set(kCasterLayers.solid);
    camera.layers.enable(kCasterLayers.float);
    renderer.render(casters.scene, camera);
    casters.scene.overrideMaterial = instances;
    camera.layers.set(kCasterLayers.instance);
    renderer.render(casters.scene, camera);
    casters.scene.overrideMaterial = null;
  }

  dispose(): void {
    this.material.dispose();
    this.instances.dispose();
  }
}

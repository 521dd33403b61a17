// The glow and the beams of lamps, in the dark; nothing by day. Reads the solids, which hide lamps, and the field, on which some float.
// Writes the canvas, whose depth holds the water that hides lamps.
import { AddEquation, CustomBlending, Mesh, OneFactor, OneMinusSrcColorFactor, Scene, Vector2, Vector3, type RawShaderMaterial, type Texture } from "three";

import type { Pass, Picture } from "../drawing/pass";
import { Lamps } from "../light/lamps";
import { makeMaterial } from "../shaders/materials";
import type { SolidsPass } from "./solids_pass";

export class LampsPass implements Pass {
  readonly name = "lamps";
  readonly reads = ["field", "solids", "canvas"] as const;
  readonly writes = ["canvas"] as const;
  private readonly lamps = new Lamps();
  private readonly material: RawShaderMaterial;
  private readonly scene = new Scene();

  constructor(
    private readonly solids: SolidsPass,
    field: Texture | undefined,
    size: { sideM: number; widthM: number },
  ) {
    const uniforms = {
      u_camera_m: { value: new Vector3() },
      u_behind_depth: { value: solids.textures.depth },
      u_resolution: { value: new Vector2(1, 1) },
      u_field: { value: field ?? null },
      u_extent_m: { value: new Vector2(size.sideM, size.widthM) },
      u_darkness: solids.darkness,
    };
    const screen = { blending: CustomBlending, blendEquation: AddEquation, blendSrc: OneFactor, blendDst: OneMinusSrcColorFactor };
    this.material = makeMaterial("lamp", uniforms, { ...screen, depthWrite: false, transparent: true });
    const mesh = new Mesh(this.lamps.geometry, this.material);
    mesh.frustumCulled = false;
    this.scene.add(mesh);
  }

  draw({ renderer, camera, sizePx, shownS }: Picture): void {
    if (this.solids.darkness.value <= 0) return;
    this.lamps.clear();
    this.solids.collectLamps(this.lamps, camera.position, shownS ?? 0);
    if (this.lamps.lampsCount === 0) return;
    this.lamps.finish();
    (this.material.uniforms["u_camera_m"]!.value as Vector3).copy(camera.position);
    (this.material.uniforms["u_resolution"]!.value as Vector2).copy(sizePx);
    renderer.setRenderTarget(null);
    renderer.render(this.scene, camera);
  }

  dispose(): void {
    this.lamps.dispose();
    this.material.dispose();
  }
}

// Drops and puffs of spray in the air, over the picture. Reads the white water, the solids' depth and the canvas. Writes the canvas.
import { NormalBlending, Vector2, type RawShaderMaterial, type Texture } from "three";

import type { Pass, Picture } from "../drawing/pass";
import type { Sky } from "../light/sky";
import { makeMaterial } from "../shaders/materials";
import type { SolidsPass } from "../solids/solids_pass";
import type { WhitePoints } from "./white_points";

export class SprayPass implements Pass {
  readonly name = "spray";
  readonly reads = ["whitewater", "solids", "canvas"] as const;
  readonly writes = ["canvas"] as const;
  private readonly material: RawShaderMaterial;

  constructor(
    private readonly points: WhitePoints,
    solids: SolidsPass,
    sky: Sky,
    noise: Texture,
  ) {
    this.material = makeMaterial(
      "spray",
      { ...sky.uniforms, u_target_px: { value: new Vector2(1, 1) }, u_behind_depth: { value: solids.textures.depth }, u_noise: { value: noise } },
      { blending: NormalBlending, transparent: true, depthWrite: false },
    );
  }

  draw({ renderer, camera, sizePx }: Picture): void {
    (this.material.uniforms["u_target_px"]!.value as Vector2).copy(sizePx);
    renderer.setRenderTarget(null);
    this.points.draw(renderer, camera, this.material);
  }

  dispose(): void {
    this.material.dispose();
  }
}

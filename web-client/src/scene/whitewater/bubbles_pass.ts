// Bubbles below the surface, drawn with the solids, so that the water is seen in front of them. Reads the white water and the solids'
// depth. Writes the solids.
import { Vector2, type RawShaderMaterial } from "three";

import type { Pass, Picture } from "../drawing/pass";
import type { Sky } from "../light/sky";
import { makeMaterial } from "../shaders/materials";
import type { SolidsPass } from "../solids/solids_pass";
import type { WhitePoints } from "./white_points";

export class BubblesPass implements Pass {
  readonly name = "bubbles";
  readonly reads = ["whitewater", "solids"] as const;
  readonly writes = ["solids"] as const;
  private readonly material: RawShaderMaterial;

  constructor(
    private readonly points: WhitePoints,
    private readonly solids: SolidsPass,
    sky: Sky,
  ) {
    this.material = makeMaterial("bubbles", { ...sky.uniforms, u_target_px: { value: new Vector2(1, 1) } }, { defines: { BUBBLES: 1 } });
  }

  draw({ renderer, camera, sizePx }: Picture): void {
    (this.material.uniforms["u_target_px"]!.value as Vector2).copy(sizePx);
    renderer.setRenderTarget(this.solids.target);
    this.points.draw(renderer, camera, this.material);
  }

  dispose(): void {
    this.material.dispose();
  }
}

// Foam as a texture over the water, which the water shows together with the streamed foam. Reads the white water. Writes the froth, seen
// from above: 0 none, 1 white; u along x, v along z. Its second channel is the light that
// hulls take from the water beside them, and of the flat shadows (shadows/flat_shadow_pass.ts).
import { RGFormat, Vector2, WebGLRenderTarget, type RawShaderMaterial, type Texture } from "three";

import type { Pass, Picture } from "../drawing/pass";
import { kAdding, makeMaterial } from "../shaders/materials";
import type { WhitePoints } from "./white_points";

export class FrothPass implements Pass {
  readonly name = "froth";
  readonly reads = ["whitewater"] as const;
  readonly writes = ["froth"] as const;
  readonly target: WebGLRenderTarget;
  private readonly material: RawShaderMaterial;

  /** `texelsCount`: along the longer side of the water. */
  constructor(
    private readonly points: WhitePoints,
    { sideM, widthM }: { sideM: number; widthM: number },
    texelsCount: number,
  ) {
    const texelsPerM = texelsCount / Math.max(sideM, widthM);
    const along = (lengthM: number): number => Math.max(Math.round(lengthM * texelsPerM), 1);
    this.target = new WebGLRenderTarget(along(sideM), along(widthM), { format: RGFormat, depthBuffer: false });
    this.material = makeMaterial("froth", { u_extent_m: { value: new Vector2(sideM, widthM) }, u_target_px: { value: texelsCount } }, {
      defines: { FROTH: 1 },
      ...kAdding,
    });
  }

  get texture(): Texture {
    return this.target.texture;
  }

  draw({ renderer, camera }: Picture): void {
    renderer.setRenderTarget(this.target);
    renderer.clear();
    this.points.draw(renderer, camera, this.material);
  }

  dispose(): void {
    this.target.dispose();
    this.material.dispose();
  }
}

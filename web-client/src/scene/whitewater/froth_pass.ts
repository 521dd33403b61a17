// Foam as a texture over the square, which the water shows together with the streamed foam. Reads the white water. Writes the froth, seen
// from above: 0 none, 1 white; u along x, v along z. Its second channel is of the flat shadows (passes/flat_shadow_pass.ts).
import { ClampToEdgeWrapping, CustomBlending, LinearFilter, MaxEquation, OneFactor, RGFormat, UnsignedByteType, WebGLRenderTarget, type RawShaderMaterial, type Texture } from "three";

import type { Pass, Picture } from "../passes/pass";
import { makeMaterial } from "../shaders";
import type { WhitePoints } from "./white_points";

export class FrothPass implements Pass {
  readonly name = "froth";
  readonly reads = ["whitewater"] as const;
  readonly writes = ["froth"] as const;
  readonly target: WebGLRenderTarget;
  private readonly material: RawShaderMaterial;

  /** `texelsCount`: along each side of the square. */
  constructor(
    private readonly points: WhitePoints,
    sideM: number,
    texelsCount: number,
  ) {
    this.target = new WebGLRenderTarget(texelsCount, texelsCount, {
      format: RGFormat,
      type: UnsignedByteType,
      minFilter: LinearFilter,
      magFilter: LinearFilter,
      wrapS: ClampToEdgeWrapping,
      wrapT: ClampToEdgeWrapping,
      depthBuffer: false,
    });
    this.material = makeMaterial("froth", { u_side_m: { value: sideM }, u_target_px: { value: texelsCount } }, {
      defines: { FROTH: 1 },
      blending: CustomBlending,
      blendEquation: MaxEquation,
      blendSrc: OneFactor,
      blendDst: OneFactor,
      depthTest: false,
      depthWrite: false,
      transparent: true,
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

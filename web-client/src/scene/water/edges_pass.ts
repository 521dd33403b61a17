// Smooths the outlines on the canvas: those between water and what stands in it follow from depths per pixel, which several samples per
// pixel do not smooth. Reads and writes the canvas.
import { FramebufferTexture, LinearFilter, Vector2 } from "three";

import { FullscreenPass } from "../drawing/fullscreen";
import type { Pass, Picture } from "../drawing/pass";
import { makeMaterial } from "../shaders/materials";

export class EdgesPass implements Pass {
  readonly name = "edges";
  readonly reads = ["canvas"] as const;
  readonly writes = ["canvas"] as const;
  private picture = makeTexture(1, 1);
  private readonly screen = new FullscreenPass(makeMaterial("edges", { u_picture: { value: this.picture }, u_texel: { value: new Vector2(1, 1) } }, { depthTest: false, depthWrite: false }));

  draw({ renderer, sizePx }: Picture): void {
    const { u_picture, u_texel } = this.screen.material.uniforms;
    if (this.picture.image.width !== sizePx.x || this.picture.image.height !== sizePx.y) {
      this.picture.dispose();
      u_picture!.value = this.picture = makeTexture(sizePx.x, sizePx.y);
      (u_texel!.value as Vector2).set(1 / sizePx.x, 1 / sizePx.y);
    }
    renderer.setRenderTarget(null);
    renderer.copyFramebufferToTexture(this.picture);
    this.screen.render(renderer, null);
  }

  dispose(): void {
    this.picture.dispose();
    this.screen.dispose();
  }
}

function makeTexture(widthPx: number, heightPx: number): FramebufferTexture {
  const texture = new FramebufferTexture(widthPx, heightPx);
  texture.minFilter = texture.magFilter = LinearFilter;
  return texture;
}

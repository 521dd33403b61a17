// The panes of a tank, over everything. Reads and writes the canvas.
import type { Object3D } from "three";

import type { Pass, Picture } from "../drawing/pass";

export class GlassPass implements Pass {
  readonly name = "glass";
  readonly reads = ["canvas"] as const;
  readonly writes = ["canvas"] as const;

  /** The caller disposes `glass`. */
  constructor(private readonly glass: Object3D) {}

  draw({ renderer, camera }: Picture): void {
    renderer.setRenderTarget(null);
    renderer.render(this.glass, camera);
  }

  dispose(): void {}
}

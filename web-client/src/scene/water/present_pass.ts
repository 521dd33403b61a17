// The solids on the canvas where there is no surface of water; seen through water if the camera is in it. Reads the solids, and the
// canvas's depth: after the water it shades the other pixels only. Writes the canvas. Where the solids are on it already, only the sky is missing.
import { FullscreenPass } from "../drawing/fullscreen";
import type { Pass, Picture } from "../drawing/pass";
import type { Sky } from "../light/sky";
import { makeMaterial } from "../shaders/materials";
import { kOnCanvas, type SolidsPass } from "../solids/solids_pass";
import type { WaterPass } from "./water_pass";

export class PresentPass implements Pass {
  readonly name = "present";
  readonly reads = ["solids", "canvas"] as const;
  readonly writes = ["canvas"] as const;
  private readonly screen: FullscreenPass;

  /** `water` undefined: the room has no wave. */
  constructor(sky: Sky, private readonly solids: SolidsPass, private readonly water: WaterPass | undefined) {
    this.screen = new FullscreenPass(makeMaterial("present", { ...sky.uniforms, u_behind: { value: solids.textures.color } }, { depthWrite: false }));
  }

  draw(picture: Picture): void {
    if (this.solids.used === kOnCanvas) return this.solids.drawSky(picture);
    this.screen.render(picture.renderer, null, this.water?.solidsBelow);
  }

  dispose(): void {
    this.screen.dispose();
  }
}

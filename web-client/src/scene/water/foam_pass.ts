// Foam frames → two byte textures that the water's shader interpolates between. Reads the foam frames around the time shown.
import { ClampToEdgeWrapping, DataTexture, LinearFilter, RedFormat, RepeatWrapping, UnsignedByteType } from "three";

import type { FoamFrame } from "../../net/messages";
import type { Pass, Picture } from "../drawing/pass";
import type { FrameRing } from "../frames/frame_ring";
import { FrameTextures, type PlaneCounts } from "../frames/frame_textures";
import type { Uniforms } from "../shaders/materials";

export class FoamPass implements Pass {
  readonly name = "foam";
  readonly reads = ["frames"] as const;
  readonly writes = ["foam"] as const;
  /** For materials that show foam. */
  readonly uniforms: Uniforms;
  private readonly frames: FrameTextures<FoamFrame>;

  constructor(
    private readonly foam: FrameRing<FoamFrame>,
    periodicX: boolean,
    periodicZ: boolean,
  ) {
    this.frames = new FrameTextures<FoamFrame>({ resolutionCount: 2, countZ: 2 }, 2, (counts) => makeTexture(counts, periodicX, periodicZ));
    const { blank } = this.frames;
    this.uniforms = { u_foam_from: { value: blank }, u_foam_to: { value: blank }, u_foam_mix: { value: 0 } };
  }

  draw({ shownS }: Picture): void {
    const foam = shownS === undefined ? undefined : this.foam.around(shownS);
    if (!foam) return;
    const { to, mix } = foam;
    let { from } = foam;
    if (from.resolutionCount !== to.resolutionCount || from.countZ !== to.countZ) from = to;
    if (!this.frames.fits(from)) this.frames.resize({ resolutionCount: from.resolutionCount, countZ: from.countZ });
    const drawn = [from, to];
    this.uniforms["u_foam_from"]!.value = this.frames.textureOf(from, drawn);
    this.uniforms["u_foam_to"]!.value = this.frames.textureOf(to, drawn);
    this.uniforms["u_foam_mix"]!.value = mix;
  }

  dispose(): void {
    this.frames.dispose();
  }
}

function makeTexture({ resolutionCount, countZ }: PlaneCounts, periodicX: boolean, periodicZ: boolean): DataTexture {
  const texture = new DataTexture(new Uint8Array(resolutionCount * countZ), resolutionCount, countZ, RedFormat, UnsignedByteType);
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.wrapS = periodicX ? RepeatWrapping : ClampToEdgeWrapping;
  texture.wrapT = periodicZ ? RepeatWrapping : ClampToEdgeWrapping;
  texture.needsUpdate = true;
  return texture;
}

// The shore as one texture, which solids and water read: where water stands, how wet the ground is, and the foam of the swash.
// Reads the frames around the time shown and the field's level of the water. Writes the shore.
import { DataTexture, LinearFilter, RGFormat, UnsignedByteType, Vector2, WebGLRenderTarget } from "three";

import { FullscreenPass } from "../drawing/fullscreen";
import type { Pass, Picture } from "../drawing/pass";
import type { Quality } from "../drawing/quality";
import type { PlaneCounts } from "../frames/frame_textures";
import type { StreamedFrames } from "../frames/streamed_frames";
import { makeMaterial, type Uniforms } from "../shaders/materials";
import type { ShoreCells } from "./shore_ground";
import type { ShoreWetness } from "./shore_wetness";

/** What the pass takes from that of the field. */
interface FieldLevel {
  readonly sizes: { width: number; height: number; counts: PlaneCounts };
  readonly levelUniforms: Uniforms;
}

export class ShorePass implements Pass {
  readonly name = "shore";
  readonly reads = ["frames", "field"] as const;
  readonly writes = ["shore"] as const;
  /** For shaders that include shore.glsl. */
  readonly uniforms: Uniforms;
  private readonly target: WebGLRenderTarget;
  private readonly screen: FullscreenPass;
  private readonly cellsPerTexel = new Vector2(1, 1);
  /** Of the frame before the time shown, and of the one after it. */
  private from: DataTexture;
  private to: DataTexture;
  private shownToS: number | undefined;

  /** `cellsOf`: the ground by the counts of a frame. `wetness` belongs to the caller, and outlives this pass. */
  constructor(
    private readonly frames: StreamedFrames,
    private readonly field: FieldLevel,
    private readonly wetness: ShoreWetness,
    private readonly cellsOf: (counts: PlaneCounts) => ShoreCells,
    { texelType }: Pick<Quality, "texelType">,
  ) {
    const { width, height } = field.sizes;
    this.target = new WebGLRenderTarget(width, height, { type: texelType, depthBuffer: false });
    this.uniforms = { u_shore: { value: this.target.texture } };
    [this.from, this.to] = [makeTexture(wetness.counts), makeTexture(wetness.counts)];
    this.screen = new FullscreenPass(
      makeMaterial(
        "shore",
        { ...field.levelUniforms, u_cells_per_texel: { value: this.cellsPerTexel }, u_wet_from: { value: this.from }, u_wet_to: { value: this.to }, u_wet_mix: { value: 0 } },
        { depthTest: false, depthWrite: false },
      ),
    );
  }

  draw(picture: Picture): void {
    const { renderer } = picture;
    this.remember(picture);
    const { width, height, counts } = this.field.sizes;
    this.target.setSize(width, height);
    this.cellsPerTexel.set(counts.resolutionCount / width, counts.countZ / height);
    this.screen.render(renderer, this.target);
  }

  remember({ shownS }: Picture): void {
    const between = shownS === undefined ? undefined : this.frames.surfaces.around(shownS);
    if (between) this.follow(between.from, between.to, between.mix);
  }

  dispose(): void {
    this.target.dispose();
    this.screen.dispose();
    this.from.dispose();
    this.to.dispose();
  }

  /** Uploads the wetness of both frames once, when the later one is shown for the first time. */
  private follow(from: Frame, to: Frame, mix: number): void {
    const uniforms = this.screen.material.uniforms;
    if (to.timeS !== this.shownToS) {
      [this.from, this.to] = [this.to, this.from];
      const foam = this.frames.foam.around(to.timeS)?.from;
      this.wetness.advance(to, foam, this.cellsOf(to));
      this.to = this.uploaded(this.to);
      const isFirst = this.shownToS === undefined || this.from.image.width !== to.resolutionCount || this.from.image.height !== to.countZ;
      if (isFirst) this.from = this.uploaded(this.from);
      this.shownToS = to.timeS;
    }
    uniforms["u_wet_from"]!.value = this.from;
    uniforms["u_wet_to"]!.value = this.to;
    uniforms["u_wet_mix"]!.value = from === to ? 1 : mix;
  }

  /** Returns the texture with the wetness of now, or another one if its size differs. */
  private uploaded(texture: DataTexture): DataTexture {
    const { counts, texels } = this.wetness;
    if (texture.image.width !== counts.resolutionCount || texture.image.height !== counts.countZ) {
      texture.dispose();
      texture = makeTexture(counts);
    }
    (texture.image.data as Uint8Array).set(texels);
    texture.needsUpdate = true;
    return texture;
  }
}

type Frame = Parameters<ShoreWetness["advance"]>[0];

function makeTexture({ resolutionCount, countZ }: PlaneCounts): DataTexture {
  const texture = new DataTexture(new Uint8Array(2 * resolutionCount * countZ), resolutionCount, countZ, RGFormat, UnsignedByteType);
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

// A sum of plane waves as a repeating texture: elevation and slopes, drawn again for every picture.
import { LinearFilter, LinearMipmapLinearFilter, RepeatWrapping, Vector4, WebGLRenderTarget, type Texture, type WebGLRenderer } from "three";

import { FullscreenPass } from "../drawing/fullscreen";
import type { TexelType } from "../drawing/quality";
import { makeMaterial } from "../shaders/materials";
import type { PlaneWave } from "./sea_state";

/** As in sea_tile.frag. Two seas of 32 waves while one fades into the next. */
const kMaxTileWaves = 64;

/** A wave whose lengths along x and z divide the tile. */
interface TileWave {
  columnsCount: number;
  rowsCount: number;
  amplitudeM: number;
  omegaRadps: number;
  phaseRad: number;
}

/** Returns the wave with a whole number of lengths per tile; its frequency stays. */
export function fitToTile(wave: PlaneWave, tileM: number): TileWave {
  const perRadpm = tileM / (2 * Math.PI);
  return {
    columnsCount: Math.round(wave.kxRadpm * perRadpm),
    rowsCount: Math.round(wave.kzRadpm * perRadpm),
    amplitudeM: wave.amplitudeM,
    omegaRadps: wave.omegaRadps,
    phaseRad: wave.phaseRad,
  };
}

/** Returns the variance of the slope, which shading needs where a pixel covers whole waves. */
export function slopeVariance(waves: readonly PlaneWave[]): number {
  return waves.reduce((sum, { amplitudeM, kxRadpm, kzRadpm }) => sum + 0.5 * amplitudeM ** 2 * (kxRadpm ** 2 + kzRadpm ** 2), 0);
}

export class SeaTile {
  /** Elevation (m), slope x, slope z; u = x/tile, v = z/tile. */
  readonly texture: Texture;
  private readonly target: WebGLRenderTarget;
  private readonly pass: FullscreenPass;
  private readonly values = Array.from({ length: kMaxTileWaves }, () => new Vector4());

  /** `smooth`: with mip levels; too slow for software renderers, whose shader fades the waves smaller than a pixel itself. `chop`: how
   * sharp the crests are, 0 for sines (sea_tile.frag). */
  constructor(readonly tileM: number, texelsCount: number, smooth: boolean, texelType: TexelType, chop: number) {
    this.target = new WebGLRenderTarget(texelsCount, texelsCount, {
      type: texelType,
      minFilter: smooth ? LinearMipmapLinearFilter : LinearFilter,
      wrapS: RepeatWrapping,
      wrapT: RepeatWrapping,
      generateMipmaps: smooth,
      depthBuffer: false,
    });
    this.texture = this.target.texture;
    this.pass = new FullscreenPass(
      makeMaterial("seaTile", { u_waves: { value: this.values }, u_count: { value: 0 }, u_tile_m: { value: tileM }, u_chop: { value: chop } }, { depthTest: false, depthWrite: false }),
    );
  }

  /** Draws groups of waves at a time, each with its share of the amplitude. Waves beyond kMaxTileWaves are left out. */
  render(renderer: WebGLRenderer, atS: number, groups: readonly { waves: readonly PlaneWave[]; share: number }[]): void {
    let count = 0;
    for (const { waves, share } of groups)
      for (const wave of waves) {
        if (count >= kMaxTileWaves || share <= 0) break;
        const { columnsCount, rowsCount, amplitudeM, omegaRadps, phaseRad } = fitToTile(wave, this.tileM);
        const turns = (omegaRadps * atS - phaseRad) / (2 * Math.PI);
        this.values[count++]!.set(columnsCount, rowsCount, share * amplitudeM, turns - Math.floor(turns));
      }
    this.pass.material.uniforms["u_count"]!.value = count;
    this.pass.render(renderer, this.target);
  }

  dispose(): void {
    this.target.dispose();
    this.pass.dispose();
  }
}

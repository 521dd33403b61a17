// Agitated water by tiles of the square: its area, which rises at once and fades, and its middle. Pure.
import { clamp } from "../scene/maths/interpolate";

/** Tiles along an axis. */
const kTilesAcross = 4;
export const kTileCount = kTilesAcross * kTilesAcross;
/** Within this time an area follows what it is measured to be. */
const kRiseS = 0.1;
const kFallS = 0.7;

export class AreaTiles {
  /** Smoothed area [m^2] and its middle [m], by tile. */
  readonly areaM2 = new Float32Array(kTileCount);
  readonly xM = new Float32Array(kTileCount);
  readonly zM = new Float32Array(kTileCount);
  private readonly sumM2 = new Float32Array(kTileCount);
  private readonly sumX = new Float32Array(kTileCount);
  private readonly sumZ = new Float32Array(kTileCount);

  clear(): void {
    this.areaM2.fill(0);
    this.sumM2.fill(0);
    this.sumX.fill(0);
    this.sumZ.fill(0);
  }

  /** Adds to the tile of a position. `sideM`, `widthM`: of the square. */
  add(xM: number, zM: number, sideM: number, widthM: number, areaM2: number): void {
    const column = clamp(Math.floor((xM / sideM + 0.5) * kTilesAcross), 0, kTilesAcross - 1);
    const tile = column + kTilesAcross * clamp(Math.floor((zM / widthM + 0.5) * kTilesAcross), 0, kTilesAcross - 1);
    this.sumM2[tile]! += areaM2;
    this.sumX[tile]! += areaM2 * xM;
    this.sumZ[tile]! += areaM2 * zM;
  }

  /** Takes what was added since the last call, `stepS` ago, as the present state. */
  settle(stepS: number): void {
    const rise = 1 - Math.exp(-stepS / kRiseS);
    const fall = 1 - Math.exp(-stepS / kFallS);
    for (let tile = 0; tile < kTileCount; ++tile) {
      const sumM2 = this.sumM2[tile]!;
      const areaM2 = this.areaM2[tile]!;
      this.areaM2[tile] = areaM2 + (sumM2 - areaM2) * (sumM2 > areaM2 ? rise : fall);
      if (sumM2 > 0) {
        this.xM[tile] = this.sumX[tile]! / sumM2;
        this.zM[tile] = this.sumZ[tile]! / sumM2;
      }
      this.sumM2[tile] = this.sumX[tile] = this.sumZ[tile] = 0;
    }
  }
}

// The water of the map: elevations shaded as hills in light from the upper left, and land. Pure.
import type { PlaneExtents } from "../../client/codec/frame_types";
import { clamp } from "../scene/maths/interpolate";

type Rgb = readonly [number, number, number];
const kTrough: Rgb = [6, 48, 84];
const kLevel: Rgb = [22, 108, 146];
const kCrest: Rgb = [196, 238, 244];
const kLand: Rgb = [205, 184, 142];
/** Slope at which the shade is full, relative to the usual slope of the water, and at least. */
const kFullSlopes = 2.6;
const kLeastFullSlope = 0.035;
/** The usual slope follows that of the picture by this share per picture. */
const kFollow = 0.08;

/** Elevations at one time: samples of two frames, and how far the time is from the first to the second. */
export interface MixedSurface extends PlaneExtents {
  from: Int16Array;
  to: Int16Array;
  mix: number;
  fromQuantumM: number;
  toQuantumM: number;
}

export class WaterShade {
  private heights = new Float32Array(0);
  private usualSlope = kLeastFullSlope;

  /** Fills RGBA pixels, one per sample. `isLand`: 1 where there is no water; empty: nowhere. */
  shade(surface: MixedSurface, isLand: Uint8Array, pixels: Uint8ClampedArray): void {
    const { resolutionCount: countX, countZ, sideM, from, to, mix, fromQuantumM, toQuantumM } = surface;
    const count = countX * countZ;
    if (this.heights.length !== count) this.heights = new Float32Array(count);
    const { heights } = this;
    const [first, second] = [fromQuantumM * (1 - mix), toQuantumM * mix];
    for (let n = 0; n < count; ++n) heights[n] = first * from[n]! + second * to[n]!;
    const perM = countX / (2 * sideM);
    const full = 1 / Math.max(kFullSlopes * this.usualSlope, kLeastFullSlope);
    let squares = 0;
    for (let k = 0; k < countZ; ++k) {
      const [above, below] = [countX * Math.max(k - 1, 0), countX * Math.min(k + 1, countZ - 1)];
      for (let i = 0; i < countX; ++i) {
        const n = countX * k + i;
        if (isLand[n] === 1) {
          write(pixels, 4 * n, kLand, kLand, 0);
          continue;
        }
        // Samples of land and obstacles have no water to compare with.
        const at = (other: number): number => heights[isLand[other] === 1 ? n : other]!;
        const alongX = (at(i > 0 ? n - 1 : n) - at(i < countX - 1 ? n + 1 : n)) * perM;
        const alongZ = (at(above + i) - at(below + i)) * perM;
        squares += alongX * alongX + alongZ * alongZ;
        // Slopes that face the light, which comes from -x and -z, are bright.
        const lit = clamp(-0.7 * (alongX + alongZ) * full, -1, 1);
        write(pixels, 4 * n, kLevel, lit < 0 ? kTrough : kCrest, Math.abs(lit));
      }
    }
    const slope = Math.sqrt(squares / Math.max(count, 1));
    if (Number.isFinite(slope)) this.usualSlope += kFollow * (slope - this.usualSlope);
  }
}

function write(pixels: Uint8ClampedArray, at: number, from: Rgb, to: Rgb, share: number): void {
  for (let c = 0; c < 3; ++c) pixels[at + c] = from[c]! + (to[c]! - from[c]!) * share;
  pixels[at + 3] = 255;
}

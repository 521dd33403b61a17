// A heightfield from its two frames before and what is read of it already: the reading half of
// server/stream/codec/surface_predictor. Whole numbers that wrap around at 32 bits, the same as there.
import type { ResidualReader } from "./residual_reader";

const kBorder = 2;
const kTile = 8;
const kWeightBits = 12;
const kHalf = 1 << (kWeightBits - 1);
export const kWeightCount = 10;

/** Samples of a square grid in quanta, row by row, with a border of two that repeats the outermost ones. */
export class SurfacePlane {
  readonly stride: number;
  readonly samples: Int16Array;

  constructor(readonly resolutionCount: number) {
    this.stride = resolutionCount + 2 * kBorder;
    this.samples = new Int16Array(this.stride * this.stride);
  }

  /** Where sample 0 of row z lies. */
  rowAt(z: number): number {
    return (z + kBorder) * this.stride + kBorder;
  }

  fillBorder(): void {
    const { samples, stride, resolutionCount: n } = this;
    for (let z = 0; z < n; ++z) {
      const at = this.rowAt(z);
      samples[at - 1] = samples[at - 2] = samples[at]!;
      samples[at + n] = samples[at + n + 1] = samples[at + n - 1]!;
    }
    const first = this.rowAt(0) - kBorder;
    const last = this.rowAt(n - 1) - kBorder;
    for (let k = 1; k <= kBorder; ++k) {
      samples.copyWithin(first - k * stride, first, first + stride);
      samples.copyWithin(last + k * stride, last, last + stride);
    }
  }

  /** The samples without border. */
  copyTo(out: Int16Array): void {
    const n = this.resolutionCount;
    for (let z = 0; z < n; ++z) {
      const at = this.rowAt(z);
      out.set(this.samples.subarray(at, at + n), z * n);
    }
  }
}

export interface SurfaceHistory {
  before?: SurfacePlane | undefined;
  earlier?: SurfacePlane | undefined;
}

/** What the frames before say about row z, rounding included, times 4096. */
function predictFromHistory(history: SurfaceHistory, w: readonly number[], z: number, out: Int32Array): void {
  const n = out.length;
  out.fill(kHalf);
  const { before, earlier } = history;
  if (before) {
    const [wHere, wNearest, wDiagonal, wFar] = w as [number, number, number, number];
    const s = before.samples;
    const stride = before.stride;
    let at = before.rowAt(z);
    // Sums of the rows above and below, three columns wide, slide along.
    let west = s[at - stride - 1]! + s[at + stride - 1]!;
    let middle = s[at - stride]! + s[at + stride]!;
    for (let x = 0; x < n; ++x, ++at) {
      const east = s[at - stride + 1]! + s[at + stride + 1]!;
      const nearest = s[at - 1]! + s[at + 1]! + middle;
      const far = s[at - 2]! + s[at + 2]! + s[at - 2 * stride]! + s[at + 2 * stride]!;
      out[x] =
        out[x]! + Math.imul(wHere, s[at]!) + Math.imul(wNearest, nearest) + Math.imul(wDiagonal, west + east) + Math.imul(wFar, far);
      west = middle;
      middle = east;
    }
  }
  if (earlier) {
    const [wHere, wNearest, wDiagonal] = w.slice(4, 7) as [number, number, number];
    const s = earlier.samples;
    const stride = earlier.stride;
    let at = earlier.rowAt(z);
    let west = s[at - stride - 1]! + s[at + stride - 1]!;
    let middle = s[at - stride]! + s[at + stride]!;
    for (let x = 0; x < n; ++x, ++at) {
      const east = s[at - stride + 1]! + s[at + stride + 1]!;
      const nearest = s[at - 1]! + s[at + 1]! + middle;
      out[x] = out[x]! + Math.imul(wHere, s[at]!) + Math.imul(wNearest, nearest) + Math.imul(wDiagonal, west + east);
      west = middle;
      middle = east;
    }
  }
}

/** Reads a plane; its border included. */
export function readPlane(reader: ResidualReader, history: SurfaceHistory, weights: readonly number[], plane: SurfacePlane): void {
  const n = plane.resolutionCount;
  const samples = plane.samples;
  const tilesCount = Math.ceil(n / kTile);
  const classes = new Uint8Array(tilesCount);
  const residuals = new Int16Array(kTile * n);
  const group = new Int16Array(kTile * kTile);
  const fromHistory = new Int32Array(n);
  const [wWest, wNorth, wNorthWest] = weights.slice(7) as [number, number, number];
  for (let top = 0; top < n; top += kTile) {
    const rows = Math.min(kTile, n - top);
    let left = 0;
    for (let tile = 0; tile < tilesCount; ++tile) {
      const columns = Math.min(kTile, n - tile * kTile);
      left = classes[tile] = reader.group(group, rows * columns, left, classes[tile]!);
      for (let j = 0; j < rows; ++j)
        for (let i = 0; i < columns; ++i) residuals[j * n + tile * kTile + i] = group[j * columns + i]!;
    }
    for (let j = 0; j < rows; ++j) {
      const z = top + j;
      predictFromHistory(history, weights, z, fromHistory);
      const at = plane.rowAt(z);
      const above = plane.rowAt(z - 1);
      // At the edges the nearest known neighbour stands for a missing one.
      let west = z > 0 ? samples[above]! : 0;
      let northWest = west;
      for (let x = 0; x < n; ++x) {
        const north = z > 0 ? samples[above + x]! : west;
        if (z === 0) northWest = west;
        const sum = (fromHistory[x]! + Math.imul(wWest, west) + Math.imul(wNorth, north) + Math.imul(wNorthWest, northWest)) | 0;
        west = samples[at + x] = ((((sum >> kWeightBits) + residuals[j * n + x]!) << 16) >> 16);
        northWest = north;
      }
    }
  }
  plane.fillBorder();
}

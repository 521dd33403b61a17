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

/** Reads a plane; its border included. */
export function readPlane(reader: ResidualReader, history: SurfaceHistory, weights: readonly number[], plane: SurfacePlane): void {
  const n = plane.resolutionCount;
  const tilesCount = Math.ceil(n / kTile);
  const classes = new Uint8Array(tilesCount);
  // Tile by tile, as they are read; a place beyond the group stays within the tile.
  const residuals = new Int16Array(kTile * kTile * tilesCount + kTile * kTile);
  // A plane that is not there counts for nothing.
  const known = Int32Array.from(weights);
  if (!history.before) known.fill(0, 0, 4);
  if (!history.earlier) known.fill(0, 4, 7);
  const before = (history.before ?? plane).samples;
  const earlier = (history.earlier ?? plane).samples;
  for (let top = 0; top < n; top += kTile) {
    const rows = Math.min(kTile, n - top);
    let left = 0;
    for (let tile = 0; tile < tilesCount; ++tile) {
      const columns = Math.min(kTile, n - tile * kTile);
      left = classes[tile] = reader.group(residuals, tile * kTile * kTile, rows * columns, left, classes[tile]!);
    }
    for (let j = 0; j < rows; ++j) readRow(plane, before, earlier, known, top + j, j, residuals);
  }
  plane.fillBorder();
}

/** Row z from its residuals, those of row j of the tiles. Sums of neighbours move along from sample to sample. */
function readRow(plane: SurfacePlane, b: Int16Array, e: Int16Array, weights: Int32Array, z: number, j: number, residuals: Int16Array): void {
  const samples = plane.samples;
  const stride = plane.stride;
  const n = plane.resolutionCount;
  const wBefore = weights[0]!, wNearest = weights[1]!, wDiagonal = weights[2]!, wFar = weights[3]!;
  const wEarlier = weights[4]!, wEarlierNearest = weights[5]!, wEarlierDiagonal = weights[6]!;
  // In row 0 all that is known is the neighbour at x - 1.
  const wWest = z > 0 ? weights[7]! : (weights[7]! + weights[8]! + weights[9]!) | 0;
  const wNorth = z > 0 ? weights[8]! : 0;
  const wNorthWest = z > 0 ? weights[9]! : 0;
  let at = plane.rowAt(z);
  let west = z > 0 ? samples[at - stride]! : 0;
  let northWest = west;
  // Before: the samples from x - 2 to x + 1, the sums above and below from x - 1 to x. Earlier likewise.
  let b0 = b[at - 2]!, b1 = b[at - 1]!, b2 = b[at]!, b3 = b[at + 1]!;
  let v1 = b[at - stride - 1]! + b[at + stride - 1]!, v2 = b[at - stride]! + b[at + stride]!;
  let e1 = e[at - 1]!, e2 = e[at]!;
  let u1 = e[at - stride - 1]! + e[at + stride - 1]!, u2 = e[at - stride]! + e[at + stride]!;
  for (let left = 0; left < n; left += kTile) {
    const columns = Math.min(kTile, n - left);
    let r = left * kTile + j * columns;
    for (const end = r + columns; r < end; ++r, ++at) {
      const b4 = b[at + 2]!;
      const v3 = b[at - stride + 1]! + b[at + stride + 1]!;
      const e3 = e[at + 1]!;
      const u3 = e[at - stride + 1]! + e[at + stride + 1]!;
      const north = samples[at - stride]!;
      const sum =
        (kHalf + Math.imul(wBefore, b2) + Math.imul(wNearest, b1 + b3 + v2) + Math.imul(wDiagonal, v1 + v3) +
          Math.imul(wFar, b0 + b4 + b[at - 2 * stride]! + b[at + 2 * stride]!) + Math.imul(wEarlier, e2) +
          Math.imul(wEarlierNearest, e1 + e3 + u2) + Math.imul(wEarlierDiagonal, u1 + u3) + Math.imul(wWest, west) +
          Math.imul(wNorth, north) + Math.imul(wNorthWest, northWest)) | 0;
      west = (((sum >> kWeightBits) + residuals[r]!) << 16) >> 16;
      samples[at] = west;
      northWest = north;
      b0 = b1;
      b1 = b2;
      b2 = b3;
      b3 = b4;
      v1 = v2;
      v2 = v3;
      e1 = e2;
      e2 = e3;
      u1 = u2;
      u2 = u3;
    }
  }
}

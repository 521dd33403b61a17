// A repeating noise tile ("lace"): cells with bright walls over cloudy noise, every brightness equally frequent. Foam shows where the
// tile is brighter than a threshold, so that foam of 0.5 covers half the water. Stone and sand take their grain from it. Beside it a tile of
// leaves, for plants.
import { DataTexture, LinearFilter, LinearMipmapLinearFilter, RedFormat, RGFormat, RepeatWrapping, UnsignedByteType } from "three";

import { smooth } from "../maths/interpolate";
import { hash } from "../maths/random";
import { makeLeaves } from "./leaves";

const kSide = 256;

/** Worley noise, F2 - F1: distance to the second nearest minus distance to the nearest of one random point per cell. Repeats after `period` cells. */
function makeCellWalls(period: number, seed: number): (x: number, y: number) => number {
  // The points of the cells, with those around them.
  const side = period + 4;
  const points = Float64Array.from({ length: 2 * side * side }, (_, n) => {
    const cell = n >> 1;
    return hash(((cell % side) - 2 + period) % period, (Math.floor(cell / side) - 2 + period) % period, seed + (n & 1));
  });
  return (x, y) => {
    let nearest = 9;
    let next = 9;
    const cx = Math.floor(x);
    const cy = Math.floor(y);
    for (let dy = -1; dy <= 1; ++dy)
      for (let dx = -1; dx <= 1; ++dx) {
        const at = 2 * ((cy + dy + 2) * side + cx + dx + 2);
        const awayX = cx + dx + points[at]! - x;
        const awayY = cy + dy + points[at + 1]! - y;
        const away = awayX * awayX + awayY * awayY;
        if (away < nearest) {
          next = nearest;
          nearest = away;
        } else if (away < next) next = away;
      }
    return Math.sqrt(next) - Math.sqrt(nearest);
  };
}

/** Smooth noise between one random value per cell. Repeats after `period` cells; x and y not negative. */
function makeCloud(period: number, seed: number): (x: number, y: number) => number {
  const side = period + 1;
  const values = Float64Array.from({ length: side * side }, (_, n) => hash((n % side) % period, Math.floor(n / side) % period, seed));
  return (x, y) => {
    const cx = Math.floor(x);
    const cy = Math.floor(y);
    const fx = smooth(x - cx);
    const fy = smooth(y - cy);
    const at = cx + side * cy;
    return (values[at]! * (1 - fx) + values[at + 1]! * fx) * (1 - fy) + (values[at + side]! * (1 - fx) + values[at + side + 1]! * fx) * fy;
  };
}

/** Returns one byte per sample, row by row; the square repeats. */
export function makeLace(side: number): Uint8Array<ArrayBuffer> {
  const raw = new Float32Array(side * side);
  const [large, small] = [makeCellWalls(9, 20), makeCellWalls(24, 30)];
  const [cloud6, cloud15, cloud40] = [makeCloud(6, 3), makeCloud(15, 4), makeCloud(40, 5)];
  for (let k = 0; k < side; ++k)
    for (let i = 0; i < side; ++i) {
      const [u, v] = [i / side, k / side];
      const clouds = 0.5 * cloud6(6 * u, 6 * v) + 0.3 * cloud15(15 * u, 15 * v) + 0.2 * cloud40(40 * u, 40 * v);
      const [wu, wv] = [u + 0.03 * clouds, v + 0.03 * (1 - clouds)];
      const walls = 0.62 * (1 - Math.min(large(9 * wu, 9 * wv), 0.7) / 0.7) + 0.38 * (1 - Math.min(small(24 * wu, 24 * wv), 0.7) / 0.7);
      raw[k * side + i] = 0.6 * walls + 0.55 * clouds;
    }
  // Rank instead of value: uniformly distributed.
  // Numbers without a comparison of our own sort ten times as fast: the value, and behind it the index.
  const order = Float64Array.from(raw, (value, at) => Math.floor(value * 2 ** 32) * raw.length + at).sort();
  const lace = new Uint8Array(side * side);
  order.forEach((key, rank) => (lace[key % raw.length] = Math.floor((256 * rank) / raw.length)));
  return lace;
}

let lace: Uint8Array<ArrayBuffer> | undefined;
let laceAndLeaves: Uint8Array<ArrayBuffer> | undefined;

/** Red: the lace; green: the leaves. `plain`: no leaves, and no mip levels, between which software renderers would interpolate at twice the cost. */
export function makeNoiseTexture(plain: boolean): DataTexture {
  const red = (lace ??= makeLace(kSide));
  if (!plain && !laceAndLeaves) {
    const leaves = makeLeaves(kSide);
    laceAndLeaves = Uint8Array.from({ length: 2 * red.length }, (_, n) => (n % 2 ? leaves : red)[n >> 1]!);
  }
  const texture = plain ? new DataTexture(red, kSide, kSide, RedFormat, UnsignedByteType) : new DataTexture(laceAndLeaves, kSide, kSide, RGFormat, UnsignedByteType);
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.magFilter = LinearFilter;
  texture.minFilter = plain ? LinearFilter : LinearMipmapLinearFilter;
  texture.generateMipmaps = !plain;
  texture.needsUpdate = true;
  return texture;
}

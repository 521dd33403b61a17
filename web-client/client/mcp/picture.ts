// A picture of a room from above, drawn from its frames without a browser: x to the right, z down.
import type { Boats, Floaters, Particles, Surface } from "../water/frames";

/** RGB, 8 bits each, row by row. */
export interface Picture {
  width: number;
  height: number;
  data: Uint8Array;
}

/** What a picture shows and how to read it. */
interface Drawn {
  picture: Picture;
  lowestM: number;
  highestM: number;
  /** Elevations that have the darkest and the brightest colour. */
  rangeM: [number, number];
}

type Rgb = readonly [number, number, number];

/** From the lowest water over the water at rest to the highest. */
const kRamp: readonly Rgb[] = [[6, 20, 58], [20, 84, 140], [96, 170, 200], [232, 244, 246]];
const kBoat: Rgb = [224, 64, 32];
const kFloater: Rgb = [240, 190, 60];
const kEmpty: Rgb = [40, 40, 44];
/** Calmer water is not stretched to the whole ramp. */
const kLeastRangeM = 0.02;

/** Draws elevations with light from the upper left, `width` pixels wide, and boats and objects as marks. */
export function drawSurface(surface: Surface, width: number, boats?: Boats, floaters?: Floaters): Drawn {
  const { lengthM, widthM, heightsM } = surface;
  const height = Math.min(Math.max(Math.round((width * widthM) / lengthM), 1), 2 * width);
  const [lowestM, highestM] = rangeOf(heightsM);
  const most = Math.max(usualExtentM(heightsM), kLeastRangeM);
  const picture = { width, height, data: new Uint8Array(3 * width * height) };
  const [stepX, stepZ] = [lengthM / width, widthM / height];
  for (let row = 0; row < height; ++row)
    for (let column = 0; column < width; ++column) {
      const [xM, zM] = [(column + 0.5) * stepX - lengthM / 2, (row + 0.5) * stepZ - widthM / 2];
      const h = surface.heightM(xM, zM);
      const slope = (h - surface.heightM(xM - stepX, zM)) / stepX + (h - surface.heightM(xM, zM - stepZ)) / stepZ;
      put(picture, column, row, rampAt(0.5 + (0.5 * h) / most), 1 + Math.min(Math.max(slope, -0.4), 0.4));
    }
  const at = (xM: number, zM: number): [number, number] => [Math.floor((xM + lengthM / 2) / stepX), Math.floor((zM + widthM / 2) / stepZ)];
  for (const { xM, zM, headingRad } of boats?.boats ?? [])
    for (const along of [-1, -0.5, 0, 0.5, 1]) mark(picture, at(xM + 3 * along * stepX * Math.cos(headingRad), zM + 3 * along * stepZ * Math.sin(headingRad)), along === 1 ? 1 : 2, kBoat);
  for (const { xM, zM } of floaters?.floaters ?? []) mark(picture, at(xM, zM), 1, kFloater);
  return { picture, lowestM, highestM, rangeM: [-most, most] };
}

/** Draws the highest particle in each pixel: of a room without a surface. */
export function drawParticles({ positionsM, count }: Particles, lengthM: number, widthM: number, width: number): Drawn {
  const height = Math.min(Math.max(Math.round((width * widthM) / lengthM), 1), 2 * width);
  const highest = new Float32Array(width * height).fill(-Infinity);
  for (let k = 0; k < count; ++k) {
    const [column, row] = [Math.floor((positionsM[3 * k]! / lengthM + 0.5) * width), Math.floor((positionsM[3 * k + 2]! / widthM + 0.5) * height)];
    if (column >= 0 && column < width && row >= 0 && row < height) highest[row * width + column] = Math.max(highest[row * width + column]!, positionsM[3 * k + 1]!);
  }
  const [lowestM, highestM] = rangeOf(highest.filter(Number.isFinite));
  const picture = { width, height, data: new Uint8Array(3 * width * height) };
  const span = Math.max(highestM - lowestM, kLeastRangeM);
  highest.forEach((yM, at) => put(picture, at % width, Math.trunc(at / width), Number.isFinite(yM) ? rampAt((yM - lowestM) / span) : kEmpty, 1));
  return { picture, lowestM, highestM, rangeM: [lowestM, lowestM + span] };
}

/** Elevation that all but one sample of fifty stay below: dry land and single crests do not flatten the rest. */
function usualExtentM(heightsM: Float32Array): number {
  const every = Math.ceil(heightsM.length / 4096);
  const extents = Float32Array.from({ length: Math.floor(heightsM.length / every) }, (_, k) => Math.abs(heightsM[k * every]!)).sort();
  return extents[Math.floor(0.98 * (extents.length - 1))]!;
}

function rangeOf(values: Float32Array): [number, number] {
  return values.length === 0 ? [0, 0] : [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))];
}

/** `share` 0..1. */
function rampAt(share: number): Rgb {
  const at = Math.min(Math.max(share, 0), 1) * (kRamp.length - 1);
  const k = Math.min(Math.trunc(at), kRamp.length - 2);
  return kRamp[k]!.map((low, channel) => low + (kRamp[k + 1]![channel]! - low) * (at - k)) as unknown as Rgb;
}

function put({ width, height, data }: Picture, column: number, row: number, color: Rgb, light: number): void {
  if (column < 0 || column >= width || row < 0 || row >= height) return;
  for (let channel = 0; channel < 3; ++channel) data[3 * (row * width + column) + channel] = Math.min(color[channel]! * light, 255);
}

function mark(picture: Picture, [column, row]: [number, number], radius: number, color: Rgb): void {
  for (let dz = -radius; dz <= radius; ++dz) for (let dx = -radius; dx <= radius; ++dx) put(picture, column + dx, row + dz, color, 1);
}

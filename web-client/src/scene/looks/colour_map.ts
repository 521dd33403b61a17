// Colour maps of 256 colours whose lightness follows the value, so that equal steps of a value look alike and differ in grey as well.
//   viridis   S. van der Walt and N. Smith, 2015: every 17th of its published colours
//   cividis   J. Nuñez, C. Anderton and R. Renslow, PLoS ONE 13(7), 2018: likewise; also for readers with impaired colour vision
//   coolWarm, purpleGreen   K. Moreland, "Diverging color maps for scientific visualization", 2009: computed between two colours
// Between the published colours lightness, a* and b* of CIELAB are linear.
import { clamp } from "../maths/interpolate";

type Triple = [number, number, number];
export type ColourMapName = "viridis" | "cividis" | "coolWarm" | "purpleGreen";

export const kColoursCount = 256;

const kPublished = {
  viridis: "440154 481a6c 472f7d 414487 39568c 31688e 2a788e 23888e 1f988b 22a884 35b779 54c568 7ad151 a5db36 d2e21b fde725",
  cividis: "00224e 002e6c 1e3a6f 35456c 47516c 575d6d 666970 757575 848279 948e77 a59c74 b7a96e c8b866 dbc75a eed649 fee838",
};
/** Ends of the diverging maps, sRGB 0..1. */
const kEnds: Record<"coolWarm" | "purpleGreen", [Triple, Triple]> = {
  coolWarm: [[0.230, 0.299, 0.754], [0.706, 0.016, 0.150]],
  purpleGreen: [[0.436, 0.308, 0.631], [0.085, 0.532, 0.201]],
};
/** Lightness of the middle of a diverging map. */
const kMiddleLightness = 88;

/** CIE XYZ of the sRGB primaries (IEC 61966-2-1), white point D65. */
const kXyz: readonly Triple[] = [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]];
const kRgb: readonly Triple[] = [[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]];
const kWhite: Triple = [0.95047, 1, 1.08883];

const dot = (a: Triple, b: Triple): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

function labOf(srgb: Triple): Triple {
  const linear = srgb.map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)) as Triple;
  const root = (t: number): number => (t > (6 / 29) ** 3 ? Math.cbrt(t) : t / (3 * (6 / 29) ** 2) + 4 / 29);
  const [x, y, z] = kXyz.map((row, i) => root(dot(row, linear) / kWhite[i]!)) as Triple;
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

function srgbOf([lightness, a, b]: Triple): Triple {
  const y = (lightness + 16) / 116;
  const cube = (t: number): number => (t > 6 / 29 ? t ** 3 : 3 * (6 / 29) ** 2 * (t - 4 / 29));
  const xyz = [y + a / 500, y, y - b / 200].map((t, i) => cube(t) * kWhite[i]!) as Triple;
  return kRgb.map((row) => {
    const c = clamp(dot(row, xyz), 0, 1);
    return c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055;
  }) as Triple;
}

function mixed(from: Triple, to: Triple, share: number): Triple {
  return from.map((value, i) => value + (to[i]! - value) * share) as Triple;
}

function sequential(published: string): (share: number) => Triple {
  const points = published.split(" ").map((hex) => labOf([0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255) as Triple));
  return (share) => {
    const at = share * (points.length - 1);
    const low = Math.min(Math.floor(at), points.length - 2);
    return srgbOf(mixed(points[low]!, points[low + 1]!, at - low));
  };
}

/** CIELAB in polar form, Moreland's Msh: length, angle from the lightness axis, hue. */
function mshOf(srgb: Triple): Triple {
  const [lightness, a, b] = labOf(srgb);
  const length = Math.hypot(lightness, a, b);
  return [length, Math.acos(lightness / length), Math.atan2(b, a)];
}

/** Returns the hue with which white of length `whiteLength` begins, so that the way to `end` spirals evenly. */
function whiteHue([length, angle, hue]: Triple, whiteLength: number): number {
  if (length >= whiteLength) return hue;
  const spin = (angle * Math.sqrt(whiteLength ** 2 - length ** 2)) / (length * Math.sin(angle));
  return hue > -Math.PI / 3 ? hue + spin : hue - spin;
}

function diverging([low, high]: [Triple, Triple]): (share: number) => Triple {
  const ends = [mshOf(low), mshOf(high)] as const;
  const middle = Math.max(ends[0][0], ends[1][0], kMiddleLightness);
  return (share) => {
    const end = share < 0.5 ? ends[0] : ends[1];
    const [length, angle, hue] = mixed([middle, 0, whiteHue(end, middle)], end, Math.abs(2 * share - 1));
    return srgbOf([length * Math.cos(angle), length * Math.sin(angle) * Math.cos(hue), length * Math.sin(angle) * Math.sin(hue)]);
  };
}

/** Returns the colours from the lowest to the highest value: sRGB and an alpha of 255, one byte each. */
export function colourMap(name: ColourMapName): Uint8Array<ArrayBuffer> {
  const colourAt = name === "viridis" || name === "cividis" ? sequential(kPublished[name]) : diverging(kEnds[name]);
  const bytes = new Uint8Array(4 * kColoursCount).fill(255);
  for (let i = 0; i < kColoursCount; ++i) bytes.set(colourAt(i / (kColoursCount - 1)).map((c) => Math.round(255 * c)), 4 * i);
  return bytes;
}

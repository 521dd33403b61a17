// The light of an hour and a weather, as numbers for the shaders: the sun or the moon, the sky, and what both give to surfaces and to
// water. Colours are linear and relative: a white surface that faces the noon sun has about 1.6. Pure: no renderer.
//
// The sky's colours are keyframes over the sun's altitude, chosen by eye (no scattering model): today's clear noon is the last one.
import { clamp, mix, smoothstep } from "../maths/interpolate";

export type Rgb = readonly [red: number, green: number, blue: number];

export interface Light {
  /** Unit vector toward the sun; below the horizon at night. The glow of the sky is around it. */
  sunDirection: Rgb;
  /** Unit vector toward what gives the direct light: the sun, by night the moon. Never below the horizon. */
  keyDirection: Rgb;
  /** Direct light on a surface that faces it. */
  key: Rgb;
  /** The sky without clouds, from the zenith down. */
  zenith: Rgb;
  middle: Rgb;
  horizon: Rgb;
  /** The sky's glow around the sun, and around the moon. */
  glow: Rgb;
  halo: Rgb;
  /** Share of `key` that comes from the disc of the sun or the moon and glints: 0 where clouds hide it. */
  sharp: number;
  /** Clouds away from the sun and near it, and the share of the sky that they cover (0..1). */
  cloud: Rgb;
  cloudLit: Rgb;
  cloudCover: number;
  /** Brightness of the stars: 0 by day, 1 at night. */
  stars: number;
  /** Light of the sky on surfaces that face up and down. */
  ambientUp: Rgb;
  ambientDown: Rgb;
  /** Factor on linear light before it is shown. */
  exposure: number;
}

/** Noon: the sun's direction, of altitude 26 degrees. */
const kNoon: Rgb = unit([-0.42, 0.44, -0.79]);
const kNoonAzimuthRad = Math.atan2(kNoon[0], -kNoon[2]);
/** Slower than a real sun, so that the usual view, along -z, has the sun's glitter from noon to sunset. */
const kAzimuthRadPerHour = (7 * Math.PI) / 180;
const kMoonAltitudeSine = 0.46;
const kMoonAzimuthRad = (-16 * Math.PI) / 180;
const kMoonLight: Rgb = [0.07, 0.092, 0.13];

type Sky = Pick<Light, "key" | "zenith" | "middle" | "horizon" | "glow" | "cloud" | "cloudLit" | "ambientUp" | "ambientDown" | "exposure">;

/** Clear sky over the sine of the sun's altitude; `key` is the sun's light. */
const kSkies: readonly (Sky & { sine: number })[] = [
  { sine: -0.30, key: [0, 0, 0], zenith: [0.004, 0.008, 0.020], middle: [0.008, 0.015, 0.033], horizon: [0.020, 0.031, 0.052], glow: [0, 0, 0], cloud: [0.030, 0.038, 0.056], cloudLit: [0.036, 0.045, 0.064], ambientUp: [0.030, 0.043, 0.070], ambientDown: [0.012, 0.016, 0.022], exposure: 1.75 },
  { sine: -0.14, key: [0, 0, 0], zenith: [0.012, 0.026, 0.072], middle: [0.040, 0.062, 0.125], horizon: [0.17, 0.15, 0.19], glow: [0.10, 0.045, 0.020], cloud: [0.055, 0.055, 0.080], cloudLit: [0.15, 0.085, 0.075], ambientUp: [0.075, 0.095, 0.145], ambientDown: [0.030, 0.033, 0.042], exposure: 1.65 },
  { sine: -0.05, key: [0, 0, 0], zenith: [0.026, 0.058, 0.155], middle: [0.115, 0.135, 0.225], horizon: [0.50, 0.30, 0.23], glow: [0.55, 0.22, 0.07], cloud: [0.15, 0.125, 0.165], cloudLit: [0.72, 0.30, 0.17], ambientUp: [0.155, 0.175, 0.24], ambientDown: [0.075, 0.068, 0.075], exposure: 1.45 },
  { sine: 0.02, key: [0.62, 0.25, 0.075], zenith: [0.032, 0.084, 0.225], middle: [0.17, 0.215, 0.33], horizon: [0.74, 0.47, 0.29], glow: [1.1, 0.44, 0.10], cloud: [0.30, 0.235, 0.25], cloudLit: [1.15, 0.56, 0.27], ambientUp: [0.225, 0.245, 0.31], ambientDown: [0.115, 0.10, 0.10], exposure: 1.25 },
  { sine: 0.10, key: [1.25, 0.74, 0.33], zenith: [0.036, 0.105, 0.29], middle: [0.19, 0.29, 0.47], horizon: [0.78, 0.64, 0.48], glow: [1.25, 0.56, 0.15], cloud: [0.52, 0.46, 0.45], cloudLit: [1.40, 0.92, 0.54], ambientUp: [0.345, 0.36, 0.40], ambientDown: [0.14, 0.135, 0.13], exposure: 1.15 },
  { sine: 0.24, key: [1.02, 0.80, 0.55], zenith: [0.036, 0.122, 0.35], middle: [0.16, 0.34, 0.61], horizon: [0.64, 0.70, 0.74], glow: [1.2, 0.68, 0.24], cloud: [0.72, 0.74, 0.78], cloudLit: [1.38, 1.14, 0.88], ambientUp: [0.35, 0.425, 0.52], ambientDown: [0.15, 0.16, 0.17], exposure: 1.03 },
  { sine: kNoon[1], key: [1.0, 0.90, 0.74], zenith: [0.035, 0.13, 0.38], middle: [0.15, 0.36, 0.68], horizon: [0.58, 0.72, 0.84], glow: [1.0, 0.75, 0.45], cloud: [0.80, 0.85, 0.92], cloudLit: [1.35, 1.22, 1.05], ambientUp: [0.38, 0.47, 0.58], ambientDown: [0.15, 0.17, 0.19], exposure: 1 },
];

/** Cover of thin clouds on a clear day, and in a storm. */
const kFairCover = 0.22;
/** The sky of a storm at noon. At other hours it is dimmed and tinted as the clear sky's horizon is. */
const kStormSky: Sky = {
  key: [0.0702, 0.0702, 0.0686], zenith: [0.0897, 0.105, 0.121], middle: [0.144, 0.164, 0.179], horizon: [0.289, 0.32, 0.335], glow: [0.039, 0.039, 0.0351],
  cloud: [0.121, 0.136, 0.148], cloudLit: [0.211, 0.222, 0.226], ambientUp: [0.234, 0.261, 0.285], ambientDown: [0.0936, 0.101, 0.105], exposure: 1.06,
};
const kNoonSky = kSkies.at(-1)!;
/** Storm level from which the sky begins to change. A breeze is under a clear sky. */
const kFairStorm = 0.3;

function unit([x, y, z]: Rgb): Rgb {
  const length = Math.hypot(x, y, z);
  return [x / length, y / length, z / length];
}

/** Combines two colours channel by channel. */
export const mapRgb = (a: Rgb, b: Rgb, of: (a: number, b: number) => number): Rgb => [of(a[0], b[0]), of(a[1], b[1]), of(a[2], b[2])];
const mixRgb = (a: Rgb, b: Rgb, share: number): Rgb => mapRgb(a, b, (x, y) => mix(x, y, share));
const scale = (a: Rgb, by: number): Rgb => mapRgb(a, a, (x) => x * by);
const luminance = ([red, green, blue]: Rgb): number => 0.2126 * red + 0.7152 * green + 0.0722 * blue;

function mixSky(a: Sky, b: Sky, share: number): Sky {
  const of = (name: Exclude<keyof Sky, "exposure">): Rgb => mixRgb(a[name], b[name], share);
  return {
    key: of("key"), zenith: of("zenith"), middle: of("middle"), horizon: of("horizon"), glow: of("glow"), cloud: of("cloud"), cloudLit: of("cloudLit"),
    ambientUp: of("ambientUp"), ambientDown: of("ambientDown"), exposure: mix(a.exposure, b.exposure, share),
  };
}

/** Returns the direction of a body that stands highest at `highestHour` at a sine of altitude, and moves on a slow arc. */
function bodyDirection(hour: number, highestHour: number, highestSine: number, azimuthRad: number): Rgb {
  let sinceH = hour - highestHour;
  sinceH -= 24 * Math.round(sinceH / 24);
  const up = highestSine * Math.cos((sinceH * Math.PI) / 12);
  const across = Math.sqrt(1 - up * up);
  const azimuth = azimuthRad + kAzimuthRadPerHour * sinceH;
  return [across * Math.sin(azimuth), up, -across * Math.cos(azimuth)];
}

function clearSky(sine: number): Sky {
  const above = kSkies.findIndex((sky) => sky.sine >= sine);
  if (above === 0) return kSkies[0]!;
  if (above < 0) return kNoonSky;
  const [from, to] = [kSkies[above - 1]!, kSkies[above]!];
  return mixSky(from, to, (sine - from.sine) / (to.sine - from.sine));
}

function stormSky(clear: Sky): Sky {
  // What is left of the noon's daylight, and half of its tint.
  const dim = luminance(clear.ambientUp) / luminance(kNoonSky.ambientUp);
  const tint = mapRgb(clear.ambientUp, kNoonSky.ambientUp, (a, b) => mix(dim, a / b, 0.5));
  const of = (name: Exclude<keyof Sky, "exposure">): Rgb => mapRgb(kStormSky[name], tint, (a, b) => a * b);
  return {
    key: of("key"), zenith: of("zenith"), middle: of("middle"), horizon: of("horizon"), glow: of("glow"), cloud: of("cloud"), cloudLit: of("cloudLit"),
    ambientUp: of("ambientUp"), ambientDown: of("ambientDown"), exposure: kStormSky.exposure * clear.exposure,
  };
}

/** Returns the light at `hour` (0..24) in a storm of `storm` (0..1). Continuous in both. */
export function lightAt(hour: number, storm: number): Light {
  const sunDirection = bodyDirection(hour, 12, kNoon[1], kNoonAzimuthRad);
  const moonDirection = bodyDirection(hour, 24, kMoonAltitudeSine, kMoonAzimuthRad);
  const clear = clearSky(sunDirection[1]);
  const wild = smoothstep(kFairStorm, 1, storm);
  const sky = mixSky(clear, stormSky(clear), wild);
  // The moon shines when the sun's light is gone, so that the direction of the light changes in the dark.
  const moonShare = smoothstep(-0.07, -0.16, sunDirection[1]) * smoothstep(0.02, 0.2, moonDirection[1]) * (1 - 0.92 * wild);
  const isMoon = moonShare > 0;
  const moon = scale(kMoonLight, moonShare);
  const keyDirection = isMoon ? moonDirection : unit([sunDirection[0], Math.max(sunDirection[1], 0.01), sunDirection[2]]);
  return {
    ...sky,
    sunDirection,
    keyDirection,
    // Nothing of the sun is left once it has set.
    key: isMoon ? moon : scale(sky.key, smoothstep(-0.012, 0.02, sunDirection[1])),
    halo: scale(moon, 0.4),
    sharp: (1 - wild) ** 2,
    cloudLit: mapRgb(sky.cloudLit, moon, (cloud, light) => cloud + 0.6 * light),
    ambientUp: mapRgb(sky.ambientUp, moon, (ambient, light) => ambient + 0.1 * light),
    cloudCover: mix(kFairCover, 1, wild),
    stars: smoothstep(...kStarSines, sunDirection[1]) * (1 - wild),
  };
}

/** Stars are seen when the sun is low: none above the first sine of its altitude, all below the second. */
const kStarSines = [-0.10, -0.26] as const;

/** Lamps are lit when the sun is low: none above the first sine of its altitude, all below the second. */
const kLampSines = [0.12, -0.06] as const;

/** Returns the values for the display of linear light, as toDisplay() of sky.glsl does. */
export function displayed({ x, y, z }: { x: number; y: number; z: number }, exposure: number): Rgb {
  const of = (linear: number): number => {
    const light = 0.86 * exposure * linear;
    return Math.sqrt(clamp((light * (2.51 * light + 0.03)) / (light * (2.43 * light + 0.59) + 0.09), 0, 1));
  };
  return [of(x), of(y), of(z)];
}

/** Returns how bright lamps are: 0 by day, 1 at night. */
export function darknessOf(light: Light): number {
  return smoothstep(...kLampSines, light.sunDirection[1]);
}

/** What follows from a light for the shaders. */
interface DerivedLight {
  /** The sky's colours with its clouds mixed in, for shaders that do not read the cube map. */
  veiled: readonly [zenith: Rgb, middle: Rgb, horizon: Rgb];
  /** Light that enters level water, relative to a clear noon: the colour of what water scatters. */
  water: Rgb;
  /** Direct light below level water on a surface that faces its refracted direction, relative to noon's times noon's colour. */
  keyBelow: Rgb;
}

/** Index of refraction of air over that of water. */
const kAirPerWater = 0.75;

/** Returns the sine of the altitude of light below level water. */
function sineBelow(sine: number): number {
  return Math.sqrt(1 - kAirPerWater ** 2 * (1 - sine * sine));
}

/** Share of the light that passes level water (Schlick's fit), times the narrowing of its beam below. */
function throughSurface(sine: number): number {
  return ((1 - (0.02 + 0.98 * (1 - sine) ** 5)) * sine) / sineBelow(sine);
}

export function derive(light: Light): DerivedLight {
  // Clouds on a clear day cover little and are thin.
  const clouds = light.cloudCover - 0.1;
  const onLevel = ({ key, ambientUp }: Pick<Light, "key" | "ambientUp">, sine: number): Rgb => mapRgb(key, ambientUp, (k, a) => 1.25 * k * sine + a);
  return {
    veiled: [mixRgb(light.zenith, light.cloud, clouds), mixRgb(light.middle, light.cloud, clouds), mixRgb(light.horizon, light.cloud, 0.3 * clouds)],
    water: mapRgb(onLevel(light, light.keyDirection[1]), onLevel(kNoonSky, kNoon[1]), (a, b) => a / b),
    keyBelow: scale(light.key, throughSurface(light.keyDirection[1]) / throughSurface(kNoon[1])),
  };
}

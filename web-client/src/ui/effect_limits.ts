// Ranges of the effect sliders: the options in scene.proto, narrowed to the limits of this room's water.
import type { GreetingInfo } from "../../client/codec/greeting";
import { kBoatRanges, kBreakingWaveRanges, kControlBoatRanges, kSetSpeedRanges, kSplashRanges } from "../../client/gen/ranges";
import type { SliderRange } from "./slider_row";

interface EffectRange extends SliderRange {
  default: number;
}

export interface EffectLimits {
  splashRadiusM: EffectRange;
  splashDepthM: EffectRange;
  waveAmplitudeM: EffectRange;
  waveLengthM: EffectRange;
  waveDirectionDeg: EffectRange;
}

/** The server's bounds: a splash or a crest as wide as the water, elevations up to nine tenths of its depth. */
const kWidestRadiusSides = 0.5;
const kLongestWaveSides = 1;
const kDeepestDepths = 0.9;

/** Sizes at first: a splash and a crest in sides of the water, the depth of a splash in radii and the height of a crest in lengths. In
    water with ripples a splash is half as wide, and a crest as long, as the slowest of them. */
const kUsual = { radiusSides: 0.1, lengthSides: 0.2, depthRadii: 0.55, heightLengths: 0.2 };
const kRadiusRipples = 0.6;
/** A slider has no more steps than this: the step of a field is for the smallest water, and is multiplied by 10 in larger ones. */
const kMostSteps = 1000;

/** `usual`: the default at most. */
function range({ label, unit, min, max, step: finest, default: fallback }: EffectRange, largest: number, usual = Infinity): EffectRange {
  const most = Math.min(max, largest);
  let step = finest;
  while (most - min > kMostSteps * step * (1 + 1e-9)) step *= 10;
  const rounded = (value: number): number => Number(value.toFixed(6));
  step = rounded(step);
  // On a step: the maximum below the bound, so that the server accepts it.
  const low = step > finest ? rounded(Math.ceil(min / step - 1e-9) * step) : min;
  const high = Math.max(rounded(Math.floor(most / step + 1e-9) * step), low);
  const first = Math.min(fallback, high, Math.max(usual, low));
  return { label, unit, min: low, max: high, step, default: first === fallback ? fallback : rounded(Math.max(Math.floor(first / step + 1e-9) * step, low)) };
}

/** Undefined if the water has no depth: no effect is possible. */
export function effectLimits(greeting: GreetingInfo): EffectLimits | undefined {
  const { sideM, depthM, rippleM = Infinity } = greeting.waterExtents;
  if (!(depthM > 0 && Number.isFinite(depthM))) return undefined;
  const splashRadiusM = range(kSplashRanges.radiusM, kWidestRadiusSides * sideM, Math.min(kUsual.radiusSides * sideM, kRadiusRipples * rippleM));
  const waveLengthM = range(kBreakingWaveRanges.lengthM, kLongestWaveSides * sideM, Math.min(kUsual.lengthSides * sideM, rippleM));
  return {
    splashRadiusM,
    splashDepthM: range(kSplashRanges.depthM, kDeepestDepths * depthM, kUsual.depthRadii * splashRadiusM.default),
    waveAmplitudeM: range(kBreakingWaveRanges.amplitudeM, kDeepestDepths * depthM, kUsual.heightLengths * waveLengthM.default),
    waveLengthM,
    waveDirectionDeg: range(kBreakingWaveRanges.directionDeg, Infinity),
  };
}

export interface BoatLimits {
  lengthM: EffectRange;
  throttleRatio: EffectRange;
  rudderRatio: EffectRange;
}

/** Longest hull as a share of the water's longer and shorter side. */
const kLongestBoatSides = 0.25;
const kLongestBoatWidths = 0.5;
/** Beam and height of a new boat as shares of its length, and its density: the shape of the proto's default boat. */
const kBoatShape = {
  beam: kBoatRanges.beamM.default / kBoatRanges.lengthM.default,
  height: kBoatRanges.heightM.default / kBoatRanges.lengthM.default,
  density: kBoatRanges.densityRatio.default,
};
/** Greatest draught as a share of the water's depth. */
const kDraughtDepths = 0.6;

/** Undefined for a scene without boats. */
export function boatLimits(greeting: GreetingInfo): BoatLimits | undefined {
  const { sideM, longM, depthM } = greeting.waterExtents;
  if (!greeting.hasBoats || !(depthM > 0 && Number.isFinite(depthM))) return undefined;
  const deepest = (kDraughtDepths * depthM) / (kBoatShape.height * kBoatShape.density);
  return {
    lengthM: range(kBoatRanges.lengthM, Math.min(kLongestBoatSides * longM, kLongestBoatWidths * sideM, deepest)),
    throttleRatio: range(kControlBoatRanges.throttleRatio, Infinity),
    rudderRatio: range(kControlBoatRanges.rudderRatio, Infinity),
  };
}

/** Returns a new boat of this length, within the ranges of its fields. */
export function boatOfLength(lengthM: number): { lengthM: number; beamM: number; heightM: number; densityRatio: number; draughtM: number } {
  const heightM = Math.max(kBoatShape.height * lengthM, kBoatRanges.heightM.min);
  const beamM = Math.max(kBoatShape.beam * lengthM, kBoatRanges.beamM.min);
  return { lengthM, beamM, heightM, densityRatio: kBoatShape.density, draughtM: kBoatShape.density * heightM };
}

/** The range of a field, with no more steps than a slider can have. */
export function fieldRange(field: EffectRange): EffectRange {
  return range(field, Infinity);
}

export function speedRange(): EffectRange {
  return fieldRange(kSetSpeedRanges.speed);
}

/** Returns what a slider's value becomes in other water: what was twice the usual size is so there, too. */
export function keptValue(value: number, before: EffectRange, now: EffectRange): number {
  return clampTo(before.default > 0 ? (value * now.default) / before.default : value, now);
}

/** Clamps a value to a range, such as that of a new room's slider. */
export function clampTo(value: number, { min, max }: Pick<SliderRange, "min" | "max">): number {
  return Math.min(Math.max(value, min), max);
}

// Ranges of the effect sliders: the options in scene.proto, narrowed to the limits of this room's water.
import { getOption, type DescField } from "@bufbuild/protobuf";

import type { GreetingInfo } from "../codec/greeting";
import { parameter } from "../gen/spindrift/v1/options_pb";
import { BoatSchema, BreakingWaveSchema, SplashSchema } from "../gen/spindrift/v1/scene_pb";
import { ControlBoatSchema, SetSpeedSchema } from "../gen/spindrift/v1/wire_pb";
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

function range(field: DescField, largest: number): EffectRange {
  const { label, unit, min, max, step, default: fallback } = getOption(field, parameter);
  // Rounded down to a step, so that the server accepts the slider's maximum.
  const top = Math.max(Math.floor(Math.min(max, largest) / step + 1e-9) * step, min);
  const rounded = Number(top.toFixed(6));
  return { label, unit, min, max: rounded, step, default: Math.min(fallback, rounded) };
}

/** Undefined if the water has no depth: no effect is possible. */
export function effectLimits(greeting: GreetingInfo): EffectLimits | undefined {
  const { sideM, depthM } = greeting.waterExtents;
  if (!(depthM > 0 && Number.isFinite(depthM))) return undefined;
  return {
    splashRadiusM: range(SplashSchema.field.radiusM, kWidestRadiusSides * sideM),
    splashDepthM: range(SplashSchema.field.depthM, kDeepestDepths * depthM),
    waveAmplitudeM: range(BreakingWaveSchema.field.amplitudeM, kDeepestDepths * depthM),
    waveLengthM: range(BreakingWaveSchema.field.lengthM, kLongestWaveSides * sideM),
    waveDirectionDeg: range(BreakingWaveSchema.field.directionDeg, Infinity),
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
const defaultOf = (field: DescField): number => getOption(field, parameter).default;
const { field: kBoat } = BoatSchema;
/** Beam and height of a new boat as shares of its length, and its density: the shape of the proto's default boat. */
const kBoatShape = {
  beam: defaultOf(kBoat.beamM) / defaultOf(kBoat.lengthM),
  height: defaultOf(kBoat.heightM) / defaultOf(kBoat.lengthM),
  density: defaultOf(kBoat.densityRatio),
};
/** Greatest draught as a share of the water's depth. */
const kDraughtDepths = 0.6;

/** Undefined for a scene without boats. */
export function boatLimits(greeting: GreetingInfo): BoatLimits | undefined {
  const { sideM, longM, depthM } = greeting.waterExtents;
  if (!greeting.hasBoats || !(depthM > 0 && Number.isFinite(depthM))) return undefined;
  const deepest = (kDraughtDepths * depthM) / (kBoatShape.height * kBoatShape.density);
  return {
    lengthM: range(BoatSchema.field.lengthM, Math.min(kLongestBoatSides * longM, kLongestBoatWidths * sideM, deepest)),
    throttleRatio: range(ControlBoatSchema.field.throttleRatio, Infinity),
    rudderRatio: range(ControlBoatSchema.field.rudderRatio, Infinity),
  };
}

/** Returns a new boat of this length, within the ranges of its fields. */
export function boatOfLength(lengthM: number): { lengthM: number; beamM: number; heightM: number; densityRatio: number; draughtM: number } {
  const heightM = Math.max(kBoatShape.height * lengthM, range(BoatSchema.field.heightM, Infinity).min);
  const beamM = Math.max(kBoatShape.beam * lengthM, range(BoatSchema.field.beamM, Infinity).min);
  return { lengthM, beamM, heightM, densityRatio: kBoatShape.density, draughtM: kBoatShape.density * heightM };
}

/** The range of a message's field, as its options say. */
export function fieldRange(field: DescField): EffectRange {
  return range(field, Infinity);
}

export function speedRange(): EffectRange {
  return range(SetSpeedSchema.field.speed, Infinity);
}

/** Clamps a value to a range, such as that of a new room's slider. */
export function clampTo(value: number, { min, max }: Pick<SliderRange, "min" | "max">): number {
  return Math.min(Math.max(value, min), max);
}

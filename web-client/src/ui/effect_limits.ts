// Ranges of the effect sliders: the options in scene.proto, narrowed to what this room's water can take.
import { getOption, type DescField } from "@bufbuild/protobuf";

import type { GreetingInfo } from "../codec/greeting";
import { parameter } from "../gen/spindrift/v1/options_pb";
import { BoatSchema, BreakingWaveSchema, SplashSchema } from "../gen/spindrift/v1/scene_pb";
import { ControlBoatSchema, SetSpeedSchema } from "../gen/spindrift/v1/wire_pb";

export interface Range {
  label: string;
  unit: string;
  min: number;
  max: number;
  step: number;
  default: number;
}

export interface EffectLimits {
  splashRadiusM: Range;
  splashDepthM: Range;
  waveAmplitudeM: Range;
  waveLengthM: Range;
  waveDirectionDeg: Range;
}

/** The server's own bounds: a splash or a crest as wide as the water, elevations that leave a tenth of its depth. */
const kWidestRadiusSides = 0.5;
const kLongestWaveSides = 1;
const kDeepestDepths = 0.9;

function range(field: DescField, largest: number): Range {
  const { label, unit, min, max, step, default: fallback } = getOption(field, parameter);
  // Rounded down to a step, so that the slider's end is a value that the server takes.
  const top = Math.max(Math.floor(Math.min(max, largest) / step + 1e-9) * step, min);
  const rounded = Number(top.toFixed(6));
  return { label, unit, min, max: rounded, step, default: Math.min(fallback, rounded) };
}

/** undefined where no water says how deep it is: nothing there to splash. */
export function effectLimits(greeting: GreetingInfo): EffectLimits | undefined {
  const { sideM, depthM } = greeting.stage;
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
  lengthM: Range;
  throttleRatio: Range;
  rudderRatio: Range;
}

/** A hull at most this share of the water's side long, and so deep that its draught leaves water under it. */
const kLongestBoatSides = 0.25;
/** Beam, height and density of a new boat as shares of its length: those of the proto's own boat. */
const kBoatShape = { beam: 0.375, height: 0.25, density: 0.4 };
const kDraughtDepths = 0.6;

/** undefined for a scene that takes no boats. */
export function boatLimits(greeting: GreetingInfo): BoatLimits | undefined {
  const { sideM, depthM } = greeting.stage;
  if (!greeting.hasBoats || !(depthM > 0 && Number.isFinite(depthM))) return undefined;
  const deepest = (kDraughtDepths * depthM) / (kBoatShape.height * kBoatShape.density);
  return {
    lengthM: range(BoatSchema.field.lengthM, Math.min(kLongestBoatSides * sideM, deepest)),
    throttleRatio: range(ControlBoatSchema.field.throttleRatio, Infinity),
    rudderRatio: range(ControlBoatSchema.field.rudderRatio, Infinity),
  };
}

/** A new boat of this length, within the ranges of its fields. */
export function boatOfLength(lengthM: number): { lengthM: number; beamM: number; heightM: number; densityRatio: number; draughtM: number } {
  const heightM = Math.max(kBoatShape.height * lengthM, range(BoatSchema.field.heightM, Infinity).min);
  const beamM = Math.max(kBoatShape.beam * lengthM, range(BoatSchema.field.beamM, Infinity).min);
  return { lengthM, beamM, heightM, densityRatio: kBoatShape.density, draughtM: kBoatShape.density * heightM };
}

export function speedRange(): Range {
  return range(SetSpeedSchema.field.speed, Infinity);
}

/** Keeps a slider's value inside a new room's range. */
export function clampTo(value: number, { min, max }: Range): number {
  return Math.min(Math.max(value, min), max);
}

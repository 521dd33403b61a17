// Ranges of the effect sliders: the options in scene.proto, narrowed to what this room's water can take.
import { getOption, type DescField } from "@bufbuild/protobuf";

import type { GreetingInfo } from "../codec/greeting";
import { parameter } from "../gen/spindrift/v1/options_pb";
import { BreakingWaveSchema, SplashSchema } from "../gen/spindrift/v1/scene_pb";

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

/** undefined for a scene without a heightfield: nothing there to splash. */
export function effectLimits(greeting: GreetingInfo): EffectLimits | undefined {
  if (!greeting.wave) return undefined;
  const { sideM, depthM } = greeting.wave;
  return {
    splashRadiusM: range(SplashSchema.field.radiusM, kWidestRadiusSides * sideM),
    splashDepthM: range(SplashSchema.field.depthM, kDeepestDepths * depthM),
    waveAmplitudeM: range(BreakingWaveSchema.field.amplitudeM, kDeepestDepths * depthM),
    waveLengthM: range(BreakingWaveSchema.field.lengthM, kLongestWaveSides * sideM),
  };
}

/** Keeps a slider's value inside a new room's range. */
export function clampTo(value: number, { min, max }: Range): number {
  return Math.min(Math.max(value, min), max);
}

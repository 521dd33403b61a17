// How hard it rains in a picture, and how hazy the air is. Pure.
import type { GreetingInfo } from "../../../client/codec/greeting";
import { ramp } from "../maths/interpolate";

/** Haze of the open air takes half of the light at this many sides of the square. */
const kHazeSides = 34;
/** So many times hazier in the hardest rain. */
const kRainHaze = 3;
/** Drops of the server per m^2 and s at which the rain in the picture is hardest: a full storm's by default. */
const kHardestPerM2S = 0.08;
/** Below this share of it a storm that raises waves is a breeze under a fair sky: no rain is drawn but the rings that the server computes. */
const kLeastShare = 0.35;

/**
 * Returns how hard it rains, 0..1. The server computes a few large drops, whose rings spread as waves; the page adds the many small ones
 * that only shade the water.
 */
export function rainShare(wind: GreetingInfo["wind"]): number {
  if (!wind) return 0;
  const share = (wind.levelRatio * wind.dropsPerM2S) / kHardestPerM2S;
  return ramp(wind.waveHeightM > 0 ? kLeastShare : 0, 1, share);
}

/** Returns the distance at which haze has half of the light. Rain makes it hazier. */
export function hazeM({ sideM, widthM, wind }: GreetingInfo): number {
  return (kHazeSides * Math.max(sideM, widthM)) / (1 + kRainHaze * rainShare(wind));
}

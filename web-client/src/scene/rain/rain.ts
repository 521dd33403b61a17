// How hard it rains in a picture, and the random places of its drops. Pure.
import type { GreetingInfo } from "../../codec/greeting";

/** Drops of the server per m^2 and s at which the rain in the picture is hardest: a full storm's by default. */
const kHardestPerM2S = 0.08;
/** Below this share of it single drops make the rings that the server computes, and no other rain is drawn: the sky is still fair then. */
const kLeastShare = 0.35;

/**
 * Returns how hard it rains, 0..1. The server computes a few large drops, whose rings spread as waves; the page adds the many small ones
 * that only shade the water.
 */
export function rainShare(wind: GreetingInfo["wind"]): number {
  if (!wind) return 0;
  const share = (wind.levelRatio * wind.dropsPerM2S) / kHardestPerM2S;
  return Math.min(Math.max((share - kLeastShare) / (1 - kLeastShare), 0), 1);
}

/** Returns `count` times `copies` vertices of four floats: three random numbers of the drop (0..1), and the copy's number. */
export function makeDropSeeds(count: number, copies: number, random: () => number): Float32Array<ArrayBuffer> {
  const seeds = new Float32Array(count * copies * 4);
  for (let drop = 0, at = 0; drop < count; ++drop) {
    const numbers = [random(), random(), random()];
    for (let copy = 0; copy < copies; ++copy, at += 4) seeds.set([...numbers, copy], at);
  }
  return seeds;
}

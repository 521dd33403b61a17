// Events → short sounds: bubbles that ring, bursts of noise, thumps. Pure.
import { clamp } from "../scene/maths/interpolate";
import { bubbleRadiusM, dampingPerS, minnaertHz } from "./bubbles";
import { hear, type Heard, type Listener } from "./hearing";
import type { SoundEvent } from "./sound_events";

/** A tone that decays, and noise round a frequency beside it. Levels are 0 to 1. */
export interface Grain extends Heard {
  toneHz: number;
  toneLevel: number;
  noiseHz: number;
  noiseLevel: number;
  decayS: number;
  /** Share by which the tone rises while it decays: a bubble near the surface (van den Doel 2005). */
  rise: number;
}

const kRise = 0.1;
/** Bubbles of an event are this much smaller than its largest, at random. */
const kSmallest = 0.25;
const kDecaysS = [0.008, 0.4] as const;
/** Frequency of a burst times the root of its radius. */
const kBurstHzRootM = 650;
const kBurstsHz = [180, 6000] as const;
/** Of hulls: frequency of the thump times the beam. */
const kThumpHzM = 110;
const kThumpsHz = [45, 220] as const;
/** Decay of a splash's noise over the square root of its radius. */
const kBurstSPerRootM = 0.25;

export function makeGrain(): Grain {
  return { level: 0, pan: 0, cutoffHz: 1000, toneHz: 440, toneLevel: 0, noiseHz: 1000, noiseLevel: 0, decayS: 0.1, rise: 0 };
}

/** Returns how many grains an event has: one of noise or a thump, and bubbles. */
export function grainCount({ kind, radiusM }: SoundEvent): number {
  if (kind === "slap" || kind === "knock") return 1;
  return radiusM > 0.05 ? 4 : 1;
}

/** Writes grain `n` of an event to `grain` and returns how much later than the event it begins [s]. */
export function grainOf(event: SoundEvent, n: number, listener: Listener, random: () => number, grain: Grain): number {
  const { kind, xM, yM, zM, areaM2, radiusM } = event;
  hear(listener, xM, yM, zM, areaM2, grain);
  grain.rise = 0;
  if (kind === "slap" || kind === "knock") {
    grain.toneHz = clamp(kThumpHzM / Math.max(2 * radiusM, 0.01), ...kThumpsHz);
    grain.toneLevel = 0.9;
    grain.noiseHz = kind === "slap" ? 700 : 300;
    grain.noiseLevel = kind === "slap" ? 0.6 : 0.25;
    grain.decayS = kind === "slap" ? 0.11 : 0.07;
    return 0;
  }
  const isBurst = n === 0 && grainCount(event) > 1;
  if (isBurst) {
    grain.toneHz = 100;
    grain.toneLevel = 0;
    grain.noiseHz = clamp(kBurstHzRootM / Math.sqrt(radiusM), ...kBurstsHz);
    grain.noiseLevel = 0.8;
    grain.decayS = clamp(kBurstSPerRootM * Math.sqrt(radiusM), 0.05, 0.6);
    return 0;
  }
  const bubbleM = bubbleRadiusM(radiusM) * (n <= 1 ? 1 : kSmallest + (1 - kSmallest) * random());
  grain.toneHz = minnaertHz(bubbleM);
  grain.toneLevel = kind === "plunge" ? 0.9 : 0.5;
  grain.noiseHz = 2 * grain.toneHz;
  grain.noiseLevel = 0.1;
  grain.decayS = clamp(1 / dampingPerS(bubbleM), ...kDecaysS);
  grain.rise = kRise;
  // A cavity closes some time after the blow.
  return n === 0 ? 0 : 0.03 + 0.12 * random() * Math.sqrt(clamp(radiusM, 0.05, 1));
}

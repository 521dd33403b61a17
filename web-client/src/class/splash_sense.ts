// Where the water stands out: splashes and crests that are much higher than the rest. Pure.
import type { SurfaceFrame } from "../net/messages";

/** Samples along each side that are looked at, at most. */
const kSamplesMax = 96;
/** A crest stands out if it is so many times the usual elevation, and at least so high, as a share of the side. */
const kTimesUsual = 4.5;
const kLeastSides = 0.004;

export function standingOut(frame: SurfaceFrame): { xM: number; zM: number } | undefined {
  const { resolutionCount, countZ, sideM, widthM, quantumM, buffer } = frame;
  const samples = new Int16Array(buffer);
  const stride = Math.max(Math.ceil(Math.max(resolutionCount, countZ) / kSamplesMax), 1);
  let [best, at, squares, count] = [0, 0, 0, 0];
  for (let k = 0; k < countZ; k += stride)
    for (let i = 0; i < resolutionCount; i += stride) {
      const value = Math.abs(samples[k * resolutionCount + i]!);
      squares += value * value;
      ++count;
      if (value <= best) continue;
      best = value;
      at = k * resolutionCount + i;
    }
  const usual = Math.sqrt(squares / Math.max(count, 1));
  if (best < kTimesUsual * usual || best * quantumM < kLeastSides * Math.min(sideM, widthM)) return undefined;
  const [i, k] = [at % resolutionCount, Math.floor(at / resolutionCount)];
  return { xM: ((i + 0.5) / resolutionCount - 0.5) * sideM, zM: ((k + 0.5) / countZ - 0.5) * widthM };
}

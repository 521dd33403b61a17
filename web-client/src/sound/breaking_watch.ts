// Breaking water: foam that grows, and white particles that fly. Pure; nothing is allocated per frame but views of the samples.
import type { FoamFrame, ParticleFrame } from "../net/messages";
import { kWordsPerParticle } from "../scene/frames/particle_values";
import { ramp } from "../scene/maths/interpolate";
import type { AreaTiles } from "./area_tiles";

/** Foam that grows by this much (of 255) between frames is new: the water breaks there. */
const kNewFoam = 24;
/** Foam that became white within this time is heard. */
const kHeardS = 1;
/** Samples looked at along an axis, and particles of a frame. */
const kPointsAcross = 128;
const kParticlesMax = 2000;
/** A particle is heard if it is this white, and from the first to the second of these speeds on. */
const kWhite = 100;
const kSpeedsMps = [0.8, 4] as const;
/** Frames further apart say nothing about growth. */
const kGapS = 0.5;

/** Adds the water whose foam grew between two frames. */
export function addFoam(from: FoamFrame, to: FoamFrame, breaking: AreaTiles): void {
  const { resolutionCount, countZ, sideM, widthM, timeS } = to;
  const stepS = timeS - from.timeS;
  // The buffer of the earlier one may have been given back.
  if (from.buffer.byteLength === 0 || from.resolutionCount !== resolutionCount || from.countZ !== countZ || !(stepS > 0 && stepS < kGapS)) return;
  const before = new Uint8Array(from.buffer);
  const after = new Uint8Array(to.buffer);
  const strideX = Math.ceil(resolutionCount / kPointsAcross);
  const strideZ = Math.ceil(countZ / kPointsAcross);
  const cellX = sideM / resolutionCount;
  const cellZ = widthM / countZ;
  const perByteM2 = ((cellX * strideX * cellZ * strideZ) / 255) * (kHeardS / stepS);
  for (let k = 0; k < countZ; k += strideZ)
    for (let i = 0, at = k * resolutionCount; i < resolutionCount; i += strideX, at += strideX) {
      const grown = after[at]! - before[at]!;
      if (grown >= kNewFoam) breaking.add((i + 0.5) * cellX - sideM / 2, (k + 0.5) * cellZ - widthM / 2, sideM, widthM, perByteM2 * grown);
    }
}

/** Adds the white particles that fly. `sideM`, `widthM`: of the water. */
export function addParticles(frame: ParticleFrame, sideM: number, widthM: number, breaking: AreaTiles): void {
  const { count, buffer, maxSpeedMps, radiusM, wordMinM, wordMaxM } = frame;
  const words = new Uint16Array(buffer, 0, count * kWordsPerParticle);
  const stride = Math.max(Math.ceil(count / kParticlesMax), 1);
  const unitMps = maxSpeedMps / 127;
  const eachM2 = stride * 4 * radiusM * radiusM;
  const perX = (wordMaxM[0] - wordMinM[0]) / 65535;
  const perZ = (wordMaxM[2] - wordMinM[2]) / 65535;
  for (let n = 0, at = 0; n < count; n += stride, at += stride * kWordsPerParticle) {
    if ((words[at + 5]! & 255) < kWhite) continue;
    const low = words[at + 3]!;
    const x = (low << 24) >> 24;
    const y = (low << 16) >> 24;
    const z = (words[at + 4]! << 24) >> 24;
    const share = ramp(kSpeedsMps[0], kSpeedsMps[1], unitMps * Math.sqrt(x * x + y * y + z * z));
    // The order on the wire is x, z, y.
    if (share > 0) breaking.add(wordMinM[0] + perX * words[at]!, wordMinM[2] + perZ * words[at + 1]!, sideM, widthM, eachM2 * share);
  }
}

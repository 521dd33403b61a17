// The sea that wind raises, as a sum of plane waves: the same 32 waves that the server lets in through the open sides, so that the sea
// drawn outside has the heights that the simulated water has at its edge. Formulas and sources: docs/wind_sea.md. Pure.
import type { WaveInfo, WindInfo } from "../../../client/codec/scene_info";
import { clamp } from "../maths/interpolate";

/** What a sea follows from, of the water that it surrounds or whose ripples it is. */
export type SeaWater = Pick<WaveInfo, "sides" | "sideM" | "widthM" | "depthM" | "resolutionCount" | "spongeWidthM" | "periodicX" | "periodicZ">;

/** amplitude cos(kx x + kz z - omega t + phase), x and z from the centre of the water. */
export interface PlaneWave {
  amplitudeM: number;
  omegaRadps: number;
  kxRadpm: number;
  kzRadpm: number;
  phaseRad: number;
}

/** As in the server (sea_state.h, sea_state.cpp). */
const kWaveCount = 32;
const kShortestWaveCells = 8;
const kLongestWaveShare = 0.5;
const kLargestHeightShare = 0.5;
const kSpreadExponent = 10;
const kPeakEnhancement = 3.3;
const kWidthBelow = 0.07;
const kWidthAbove = 0.09;
const kDevelopedFetch = 15625;
const kSmallestVarianceM2 = 1e-12;
const kIntegrationSteps = 4000;

const kMask64 = (1n << 64n) - 1n;

/** SplitMix64, as in the server. Returns numbers uniform in [0, 1). */
export function makeRandom(seed: bigint): () => number {
  let state = seed & kMask64;
  return () => {
    state = (state + 0x9e3779b97f4a7c15n) & kMask64;
    let z = state;
    z = ((z ^ (z >> 30n)) * 0xbf58476d1ce4e5b9n) & kMask64;
    z = ((z ^ (z >> 27n)) * 0x94d049bb133111ebn) & kMask64;
    z ^= z >> 31n;
    return Number(z >> 11n) * 2 ** -53;
  };
}

/** Fields of the wind that a room's parameters set, by their paths in the scene. */
const kWindPaths: Readonly<Record<string, Exclude<keyof WindInfo, "seed" | "comesIn">>> = {
  "storm.level_ratio": "levelRatio",
  "storm.drops_per_m2_s": "dropsPerM2S",
  "storm.wave_height_m": "waveHeightM",
  "storm.wind_direction_deg": "directionDeg",
  "storm.wind_speed_mps": "speedMps",
  "storm.fetch_m": "fetchM",
  gravity_mps2: "gravityMps2",
};

/** Returns the wind after a change of a parameter; the same object if the parameter is not one of the wind's. */
export function withParameter(wind: WindInfo, path: string, value: number): WindInfo {
  const field = kWindPaths[path];
  return field ? { ...wind, [field]: value } : wind;
}

/** Returns omega of Airy's relation, rad/s. */
export function waveFrequencyRadps(kRadpm: number, gravityMps2: number, depthM: number): number {
  return Math.sqrt(gravityMps2 * kRadpm * Math.tanh(kRadpm * depthM));
}

/** Returns k > 0 with omega^2 = g k tanh(k d), rad/m. */
function waveNumberRadpm(omegaRadps: number, gravityMps2: number, depthM: number): number {
  const y = (omegaRadps * omegaRadps * depthM) / gravityMps2;
  let x = Math.sqrt(y) * Math.max(1, Math.sqrt(y)) + 1e-12;
  for (let k = 0; k < 60; ++k) {
    const t = Math.tanh(x);
    const next = x - (x * t - y) / (t + x * (1 - t * t));
    const isDone = Math.abs(next - x) <= 1e-14 * x;
    x = next;
    if (isDone) break;
  }
  return x / depthM;
}

/** A density over an interval, for its integral and its quantiles. */
class Distribution {
  private readonly sums = [0];
  private readonly step: number;

  constructor(private readonly from: number, to: number, density: (at: number) => number) {
    this.step = (to - from) / kIntegrationSteps;
    for (let k = 0; k < kIntegrationSteps; ++k) this.sums.push(this.sums[k]! + density(from + (k + 0.5) * this.step) * this.step);
  }

  get integral(): number {
    return this.sums[kIntegrationSteps]!;
  }

  quantile(share: number): number {
    const wanted = clamp(share, 0, 1) * this.integral;
    const above = this.sums.findIndex((sum) => sum > wanted);
    if (above < 0) return this.from + kIntegrationSteps * this.step;
    const low = this.sums[above - 1]!;
    return this.from + (above - 1 + (wanted - low) / (this.sums[above]! - low)) * this.step;
  }
}

/** Variance of the elevation per unit of frequency, m^2 s (TMA spectrum). */
function makeSpectrum(wind: WindInfo, depthM: number): (omegaRadps: number) => number {
  const g = wind.gravityMps2;
  const speedMps = wind.levelRatio * wind.speedMps;
  const fetch = Math.min((g * wind.fetchM) / speedMps ** 2, kDevelopedFetch);
  const alpha = 0.076 * fetch ** -0.22;
  const peakRadps = ((22 * g) / speedMps) * Math.cbrt(1 / fetch);
  return (omega) => {
    const ratio = omega / peakRadps;
    const width = ratio <= 1 ? kWidthBelow : kWidthAbove;
    const peak = kPeakEnhancement ** Math.exp(-0.5 * ((ratio - 1) / width) ** 2);
    const deep = alpha * g * g * omega ** -5 * Math.exp(-1.25 * ratio ** -4) * peak;
    const kd = waveNumberRadpm(omega, g, depthM) * depthM;
    return (deep * Math.tanh(kd) ** 2) / (kd > 300 ? 1 : 1 + (2 * kd) / Math.sinh(2 * kd));
  };
}

/** Returns the numbers below kWaveCount in the order of the multiples of the golden ratio (modulo 1, from `begin`). */
function mixedOrder(begin: number): number[] {
  const golden = (1 + Math.sqrt(5)) / 2;
  const multiples = Array.from({ length: kWaveCount }, (_, n) => (begin + n / golden) % 1);
  return multiples.map((each) => multiples.filter((other) => other < each).length);
}

/** Returns true if a wave of this direction comes from an open side. With wind from the land a harbor is calm. */
function entersThroughOpenSide(wave: SeaWater, kxRadpm: number, kzRadpm: number): boolean {
  const { sides } = wave;
  return (kxRadpm !== 0 && sides[kxRadpm > 0 ? "-x" : "+x"] === "open") || (kzRadpm !== 0 && sides[kzRadpm > 0 ? "-z" : "+z"] === "open");
}

/** Returns the waves of the scene's storm; none at level 0, without wind, and none from closed sides. */
export function seaStateOf(wave: SeaWater, wind: WindInfo): PlaneWave[] {
  const { gravityMps2: g, levelRatio } = wind;
  const d = wave.depthM;
  const cellM = wave.sideM / wave.resolutionCount;
  if (!(levelRatio * wind.speedMps > 0 && g > 0 && wind.fetchM > 0)) return [];
  const lowest = waveFrequencyRadps((2 * Math.PI) / (kLongestWaveShare * Math.max(wave.sideM, wave.widthM)), g, d);
  const highest = waveFrequencyRadps((2 * Math.PI) / (kShortestWaveCells * cellM), g, d);
  const energy = new Distribution(lowest, highest, makeSpectrum(wind, d));
  const capM = levelRatio * Math.min(wind.waveHeightM, kLargestHeightShare * d);
  const varianceM2 = Math.min(energy.integral, (capM * capM) / 16);
  if (!(varianceM2 > kSmallestVarianceM2)) return [];

  const spread = new Distribution(-Math.PI / 2, Math.PI / 2, (angle) => Math.cos(angle / 2) ** (2 * kSpreadExponent));
  const random = makeRandom(wind.seed * 0x9fb21c651e98df25n + 1n);
  const place = mixedOrder(random());
  const waves: PlaneWave[] = [];
  for (let n = 0; n < kWaveCount; ++n) {
    const omega = energy.quantile((n + random()) / kWaveCount);
    const angle = (wind.directionDeg * Math.PI) / 180 + spread.quantile((place[n]! + 0.5) / kWaveCount);
    let k = waveNumberRadpm(omega, g, d);
    let [kxRadpm, kzRadpm] = [k * Math.cos(angle), k * Math.sin(angle)];
    // A whole number of waves between periodic sides.
    if (wave.periodicX) kxRadpm = wholeWaves(kxRadpm, wave.sideM);
    if (wave.periodicZ) kzRadpm = wholeWaves(kzRadpm, wave.widthM);
    k = Math.hypot(kxRadpm, kzRadpm);
    const phaseRad = 2 * Math.PI * random();
    if (k <= 0 || (wind.comesIn && !entersThroughOpenSide(wave, kxRadpm, kzRadpm))) continue;
    waves.push({ amplitudeM: Math.sqrt((2 * varianceM2) / kWaveCount), omegaRadps: waveFrequencyRadps(k, g, d), kxRadpm, kzRadpm, phaseRad });
  }
  return waves;
}

/** Returns the wave number nearest to `kRadpm` with a whole number of waves between sides that are `lengthM` apart. */
function wholeWaves(kRadpm: number, lengthM: number): number {
  const whole = (2 * Math.PI) / lengthM;
  return whole * Math.round(kRadpm / whole);
}

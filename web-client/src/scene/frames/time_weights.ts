// How much each of four frames counts at a time between the second and the third: a cubic Hermite curve, as Catmull-Rom's, for
// frames that need not be evenly spaced. A straight line would lower the crest of a short wave by cos(omega dt / 2) halfway between
// two frames, so that its height would pulse at the frame rate.

/** Times of the frames [s]; `beforeS` and `afterS` are undefined if there is no such frame. */
export interface FrameTimes {
  beforeS: number | undefined;
  fromS: number;
  toS: number;
  afterS: number | undefined;
}

/** A neighbour further away than this many times the interval says nothing about the slope of a short wave. */
const kMostIntervals = 2;

type Weights = [number, number, number, number];

/** Returns the intervals before and after the two frames, in units of the one between them; 0 where there is no usable neighbour. */
function neighboursOf({ beforeS, fromS, toS, afterS }: Readonly<FrameTimes>): [a: number, b: number] {
  const intervalS = toS - fromS;
  const near = (gapS: number): number => (intervalS > 0 && gapS > 0 && gapS <= kMostIntervals * intervalS ? gapS / intervalS : 0);
  return [beforeS === undefined ? 0 : near(fromS - beforeS), afterS === undefined ? 0 : near(afterS - toS)];
}

/** Adds the curvatures of the parabolas at both frames, times the given shares, to the weights. */
function addCurvatures(out: Weights, a: number, b: number, atFrom: number, atTo: number): void {
  if (a > 0) {
    out[0] -= atFrom / (a * (a + 1));
    out[1] += atFrom / a;
    out[2] -= atFrom / (a + 1);
  }
  if (b > 0) {
    out[1] -= atTo / (b + 1);
    out[2] += atTo / b;
    out[3] -= atTo / (b * (b + 1));
  }
}

/**
 * Writes the weights of the frames before, from, to and after into `out`. They sum to 1. The slope at each frame is that of the
 * parabola through it and its neighbours; with one neighbour the curve is a parabola, with none a straight line. `mix`: position
 * between from and to, 0..1.
 */
export function timeWeights(times: Readonly<FrameTimes>, mix: number, out: Weights): void {
  const [a, b] = neighboursOf(times);
  const u = mix;
  out[0] = out[3] = 0;
  out[1] = 1 - u;
  out[2] = u;
  // The line plus u (1 - u) times the curvature at either end: (1 - u) of the one at `from` and u of the one at `to`.
  const alone = u * (1 - u);
  addCurvatures(out, a, b, b === 0 ? alone : alone * (1 - u), a === 0 ? alone : alone * u);
}

/**
 * Writes the derivatives of these weights by time [1/s] into `out`. They sum to 0. At a single frame (`fromS` equal to `toS`) they are
 * those of the straight line to a neighbour; false without one, because the rate is not known.
 */
export function timeRateWeights(times: Readonly<FrameTimes>, mix: number, out: Weights): boolean {
  const { beforeS, fromS, toS, afterS } = times;
  const intervalS = toS - fromS;
  out[0] = out[1] = out[2] = out[3] = 0;
  if (!(intervalS > 0)) {
    const gapS = beforeS !== undefined ? fromS - beforeS : afterS !== undefined ? afterS - toS : 0;
    if (!(gapS > 0)) return false;
    const first = beforeS !== undefined ? 0 : 2;
    out[first] = -1 / gapS;
    out[first + 1] = 1 / gapS;
    return true;
  }
  const [a, b] = neighboursOf(times);
  const u = mix;
  const alone = 1 - 2 * u;
  out[1] = -1;
  out[2] = 1;
  addCurvatures(out, a, b, b === 0 ? alone : (1 - u) * (1 - 3 * u), a === 0 ? alone : u * (2 - 3 * u));
  for (let i = 0; i < 4; ++i) out[i]! /= intervalS;
  return true;
}

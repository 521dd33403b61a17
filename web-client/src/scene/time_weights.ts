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

/**
 * Writes the weights of the frames before, from, to and after into `out`. They sum to 1. The slope at each frame is that of the
 * parabola through it and its neighbours; with one neighbour the curve is a parabola, with none a straight line. `mix`: position
 * between from and to, 0..1.
 */
export function timeWeights(times: Readonly<FrameTimes>, mix: number, out: [number, number, number, number]): void {
  const { fromS, toS } = times;
  const intervalS = toS - fromS;
  // Intervals before and after, in units of the one between; 0 if there is no usable neighbour.
  const near = (gapS: number): number => (intervalS > 0 && gapS > 0 && gapS <= kMostIntervals * intervalS ? gapS / intervalS : 0);
  const a = times.beforeS === undefined ? 0 : near(fromS - times.beforeS);
  const b = times.afterS === undefined ? 0 : near(times.afterS - toS);
  const u = mix;
  out[0] = out[3] = 0;
  out[1] = 1 - u;
  out[2] = u;
  if (a === 0 && b === 0) return;
  // The line plus u (1 - u) times the curvature at either end: (1 - u) of the one at `from` and u of the one at `to`.
  const atFrom = u * (1 - u) * (a === 0 ? 0 : b === 0 ? 1 : 1 - u);
  const atTo = u * (1 - u) * (b === 0 ? 0 : a === 0 ? 1 : u);
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

// Bounds, ramps and values between others.

export function clamp(value: number, low: number, high: number): number {
  return Math.min(Math.max(value, low), high);
}

/** Returns 0 below `from`, 1 above `to`, linear between. */
export function ramp(from: number, to: number, at: number): number {
  return clamp((at - from) / (to - from), 0, 1);
}

/** Returns an even start and end for a share 0..1. */
export function smooth(share: number): number {
  return share * share * (3 - 2 * share);
}

export function smoothstep(from: number, to: number, at: number): number {
  return smooth(ramp(from, to, at));
}

export function mix(a: number, b: number, share: number): number {
  return a + (b - a) * share;
}

/** Returns the same angle in -pi..pi. */
export function wrapAngle(angle: number): number {
  return angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
}

/** Interpolates between two angles by the shorter arc; the result is in -pi..pi. */
export function mixAngle(from: number, to: number, share: number): number {
  return wrapAngle(from + wrapAngle(to - from) * share);
}

/** A rectangle round the origin, with samples at the centres of its cells; x fastest. */
interface Samples {
  lengthXM: number;
  lengthZM: number;
  countX: number;
  countZ: number;
  /** Beyond a periodic edge are the samples of the opposite one, beyond another edge its own again. */
  periodicX?: boolean;
  periodicZ?: boolean;
}

/** Returns the bilinear value at (x, z); `at`: value of the sample with this index. */
export function bilinear({ lengthXM, lengthZM, countX, countZ, periodicX, periodicZ }: Samples, xM: number, zM: number, at: (index: number) => number): number {
  const u = (xM / lengthXM + 0.5) * countX - 0.5;
  const v = (zM / lengthZM + 0.5) * countZ - 0.5;
  const held = (i: number, count: number, isPeriodic = false): number => (isPeriodic ? ((i % count) + count) % count : clamp(i, 0, count - 1));
  const [i, k] = [Math.floor(u), Math.floor(v)];
  const [left, right] = [held(i, countX, periodicX), held(i + 1, countX, periodicX)];
  const row = (k: number): number => {
    const first = countX * held(k, countZ, periodicZ);
    return mix(at(first + left), at(first + right), u - i);
  };
  return mix(row(k), row(k + 1), v - k);
}

// Values between the samples of a plane.

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
  const held = (i: number, count: number, isPeriodic = false): number => (isPeriodic ? ((i % count) + count) % count : Math.min(Math.max(i, 0), count - 1));
  const [i, k] = [Math.floor(u), Math.floor(v)];
  const [left, right] = [held(i, countX, periodicX), held(i + 1, countX, periodicX)];
  const between = (a: number, b: number, share: number): number => a + (b - a) * share;
  const row = (k: number): number => {
    const first = countX * held(k, countZ, periodicZ);
    return between(at(first + left), at(first + right), u - i);
  };
  return between(row(k), row(k + 1), v - k);
}

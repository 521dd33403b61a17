// Intersects a ray with the water.

export interface Ray {
  originM: readonly [number, number, number];
  /** Unit length. */
  direction: readonly [number, number, number];
}

export interface WaterShape {
  sideM: number;
  widthM: number;
  /** Bounds of elevationAtM. */
  minM: number;
  maxM: number;
  elevationAtM(xM: number, zM: number): number;
}

const kMarchCount = 64;
const kBisectCount = 20;

/** Returns the point where the ray first goes under the water from above; undefined if it misses the water. */
export function pickWater(ray: Ray, water: WaterShape): { xM: number; zM: number } | undefined {
  const [ox, oy, oz] = ray.originM;
  const [dx, dy, dz] = ray.direction;
  if (!(dy < 0)) return undefined;
  const slackM = 1e-4;
  let from = Math.max((water.maxM + slackM - oy) / dy, 0);
  const end = (water.minM - slackM - oy) / dy;
  if (end < 0) return undefined;
  const heightAbove = (t: number): number => oy + t * dy - water.elevationAtM(ox + t * dx, oz + t * dz);
  const step = (end - from) / kMarchCount;
  let to = end;
  for (let i = 1; i <= kMarchCount; ++i) {
    const t = i === kMarchCount ? end : from + step;
    if (heightAbove(t) <= 0) {
      to = t;
      break;
    }
    from = t;
  }
  for (let i = 0; i < kBisectCount; ++i) {
    const middle = (from + to) / 2;
    if (heightAbove(middle) > 0) from = middle;
    else to = middle;
  }
  const xM = ox + to * dx;
  const zM = oz + to * dz;
  return Math.abs(xM) <= water.sideM / 2 && Math.abs(zM) <= water.widthM / 2 ? { xM, zM } : undefined;
}

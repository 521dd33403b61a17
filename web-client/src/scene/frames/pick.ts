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
  /** Level of the floor of a tank whose sides are panes of glass; undefined for others. */
  glassFromM?: number | undefined;
  elevationAtM(xM: number, zM: number): number;
}

const kMarchCount = 64;
const kBisectCount = 20;
/** Tolerance for rounding at the edge of a pane, as a share of half the side. */
const kPaneSlack = 1e-6;

/** Returns the point where the ray first goes into the water, from above or through a pane of a tank; undefined if it misses the water. */
export function pickWater(ray: Ray, water: WaterShape): { xM: number; zM: number } | undefined {
  return throughPane(ray, water) ?? fromAbove(ray, water);
}

/** Returns the point where the ray crosses a pane with water behind it. */
function throughPane({ originM: [ox, oy, oz], direction: [dx, dy, dz] }: Ray, water: WaterShape): { xM: number; zM: number } | undefined {
  if (water.glassFromM === undefined) return undefined;
  const halfXM = water.sideM / 2;
  const halfZM = water.widthM / 2;
  const entryOf = (from: number, along: number, halfM: number): number => (along === 0 ? (Math.abs(from) <= halfM ? -Infinity : Infinity) : (-Math.sign(along) * halfM - from) / along);
  const t = Math.max(entryOf(ox, dx, halfXM), entryOf(oz, dz, halfZM));
  if (!(t > 0) || t === Infinity) return undefined;
  const atXM = ox + t * dx;
  const atZM = oz + t * dz;
  const xM = Math.max(-halfXM, Math.min(halfXM, atXM));
  const zM = Math.max(-halfZM, Math.min(halfZM, atZM));
  if (Math.hypot(atXM - xM, atZM - zM) > kPaneSlack * halfXM) return undefined;
  const yM = oy + t * dy;
  return yM >= water.glassFromM && yM <= water.elevationAtM(xM, zM) ? { xM, zM } : undefined;
}

function fromAbove(ray: Ray, water: WaterShape): { xM: number; zM: number } | undefined {
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

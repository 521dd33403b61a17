// The bed: level at the scene's depth, rising toward sides with a beach, with dry land behind a shore; or the ground that the server
// sends for a scene with a bed. Pure.
import type { GreetingInfo } from "../../../client/codec/greeting";
import type { GroundGrid } from "../../../client/codec/ground";
import { kSideNames, type BeachInfo, type SideName } from "../../../client/codec/scene_info";
import { bilinear } from "../../../client/codec/bilinear";
import { clamp } from "../maths/interpolate";

/** Width of the land behind a shore: kLandBeaches of the beach's width, at most kLandSides of the water's longer side. */
const kLandBeaches = 0.45;
const kLandSides = 0.12;
/** A side shallower than this share of the depth is a shore with land behind it. */
const kShoreDepths = 0.02;

/** Length of the water along x, and width along z. */
interface Sides {
  sideM: number;
  widthM: number;
}

export interface Bed extends Sides {
  depthM: number;
  beaches: readonly BeachInfo[];
  /** If there, it counts inside the water instead of depth and beaches. */
  ground?: GroundGrid | undefined;
}

export function bedOf(greeting: Pick<GreetingInfo, "sideM" | "widthM" | "waterExtents" | "beaches" | "ground">): Bed {
  const { sideM, widthM, waterExtents, beaches, ground } = greeting;
  return { sideM, widthM, depthM: waterExtents.depthM, beaches, ground };
}

/** Returns whether the water is seen through glass. */
export function isTank({ setting }: Pick<GreetingInfo, "setting">): boolean {
  return setting === "glassTank" || setting === "flume";
}

/** The size by which what is around the water is scaled. */
export function longSideM({ sideM, widthM }: Sides): number {
  return Math.max(sideM, widthM);
}

/** Returns the distance from the side to a point inside the water; negative outside. */
export function insideM(side: SideName, { sideM, widthM }: Sides, xM: number, zM: number): number {
  const isX = side[1] === "x";
  const along = isX ? xM : zM;
  return (isX ? sideM : widthM) / 2 - (side[0] === "+" ? along : -along);
}

/** Returns whether a side with this still-water depth is a shore. */
export function isShoreDepth(bed: Bed, depthM: number): boolean {
  return depthM <= kShoreDepths * bed.depthM;
}

/** Returns the width of the dry land drawn behind this beach; 0 if its side is under water. */
export function landWidthM(bed: Bed, beach: BeachInfo): number {
  if (!isShoreDepth(bed, beach.shoreDepthM)) return 0;
  return Math.min(kLandBeaches * beach.widthM, kLandSides * longSideM(bed));
}

/** Returns the still-water depth inside the water, as the server computes it; 0 at a shore, negative on land. */
export function depthAtM(bed: Bed, xM: number, zM: number): number {
  if (bed.ground) {
    const { countX, countZ, lengthM, widthM, riseM } = bed.ground;
    return -bilinear({ lengthXM: lengthM, lengthZM: widthM, countX, countZ }, xM, zM, (at) => riseM[at]!);
  }
  let depthM = bed.depthM;
  for (const beach of bed.beaches) {
    const share = clamp(insideM(beach.side, bed, xM, zM) / beach.widthM, 0, 1);
    depthM = Math.min(depthM, beach.shoreDepthM + (bed.depthM - beach.shoreDepthM) * share);
  }
  return depthM;
}

/** Returns the height of the ground with the land behind shores, which rises further and levels off; y = 0 at the still water. */
export function groundHeightM(bed: Bed, xM: number, zM: number): number {
  let heightM = -depthAtM(bed, xM, zM);
  for (const beach of bed.beaches) {
    const landM = landWidthM(bed, beach);
    const outM = Math.min(-insideM(beach.side, bed, xM, zM), landM);
    if (outM <= 0 || landM <= 0) continue;
    const slope = (bed.depthM - beach.shoreDepthM) / beach.widthM;
    heightM = Math.max(heightM, -beach.shoreDepthM + slope * outM * (1 - outM / (2 * landM)));
  }
  return heightM;
}

/** Returns the bounds of the drawn ground: the water and the land behind its shores. */
export function groundExtent(bed: Bed): { minXM: number; maxXM: number; minZM: number; maxZM: number } {
  const [halfX, halfZ] = [bed.sideM / 2, bed.widthM / 2];
  const extent = { minXM: -halfX, maxXM: halfX, minZM: -halfZ, maxZM: halfZ };
  for (const beach of bed.beaches) {
    const landM = landWidthM(bed, beach);
    if (beach.side === "+x") extent.maxXM += landM;
    else if (beach.side === "-x") extent.minXM -= landM;
    else if (beach.side === "+z") extent.maxZM += landM;
    else extent.minZM -= landM;
  }
  return extent;
}

/** Returns the uniforms of bed.glsl: widths and depths at the sides +x, -x, +z, -z; a side without a beach has the scene's depth. */
export function bedUniformValues(bed: Bed): { widthsM: number[]; shoreDepthsM: number[] } {
  const beachOf = (side: SideName): BeachInfo | undefined => bed.beaches.find((beach) => beach.side === side);
  return {
    widthsM: kSideNames.map((side) => beachOf(side)?.widthM ?? 1),
    shoreDepthsM: kSideNames.map((side) => beachOf(side)?.shoreDepthM ?? bed.depthM),
  };
}

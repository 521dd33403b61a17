// The bed: level at the scene's depth, rising toward sides with a beach, and some dry land behind a shore. Pure.
import type { GreetingInfo } from "../codec/greeting";
import type { BeachInfo, SideName } from "../codec/scene_info";

const kSides: readonly SideName[] = ["+x", "-x", "+z", "-z"];
/** Land behind a shore: this share of the beach's width, at most this share of the water's side. */
const kLandBeaches = 0.45;
const kLandSides = 0.12;
/** A side shallower than this share of the depth is a shore; a deeper one ends in water. */
const kShoreDepths = 0.02;

export interface Bed {
  sideM: number;
  depthM: number;
  beaches: readonly BeachInfo[];
}

export function bedOf(greeting: Pick<GreetingInfo, "sideM" | "stage" | "beaches">): Bed {
  return { sideM: greeting.sideM, depthM: greeting.stage.depthM, beaches: greeting.beaches };
}

/** How far inside of the side a place lies; negative outside. */
function insideM(side: SideName, sideM: number, xM: number, zM: number): number {
  const along = side[1] === "x" ? xM : zM;
  return sideM / 2 - (side[0] === "+" ? along : -along);
}

/** Width of the dry land that is drawn behind this beach; 0 where its side lies under water. */
export function landWidthM(bed: Bed, beach: BeachInfo): number {
  if (beach.shoreDepthM > kShoreDepths * bed.depthM) return 0;
  return Math.min(kLandBeaches * beach.widthM, kLandSides * bed.sideM);
}

/** Still-water depth over the bed inside of the water's square, as the server has it; 0 at a shore. */
export function depthAtM(bed: Bed, xM: number, zM: number): number {
  let depthM = bed.depthM;
  for (const beach of bed.beaches) {
    const share = Math.min(Math.max(insideM(beach.side, bed.sideM, xM, zM) / beach.widthM, 0), 1);
    depthM = Math.min(depthM, beach.shoreDepthM + (bed.depthM - beach.shoreDepthM) * share);
  }
  return depthM;
}

/** Height of the ground, y = 0 at the still water, with the land behind shores: it goes on rising and levels off. */
export function groundHeightM(bed: Bed, xM: number, zM: number): number {
  let heightM = -depthAtM(bed, xM, zM);
  for (const beach of bed.beaches) {
    const landM = landWidthM(bed, beach);
    const outM = Math.min(-insideM(beach.side, bed.sideM, xM, zM), landM);
    if (outM <= 0 || landM <= 0) continue;
    const slope = (bed.depthM - beach.shoreDepthM) / beach.widthM;
    heightM = Math.max(heightM, -beach.shoreDepthM + slope * outM * (1 - outM / (2 * landM)));
  }
  return heightM;
}

/** What is drawn of the ground: the square and the land behind its shores. */
export function groundExtent(bed: Bed): { minXM: number; maxXM: number; minZM: number; maxZM: number } {
  const half = bed.sideM / 2;
  const extent = { minXM: -half, maxXM: half, minZM: -half, maxZM: half };
  for (const beach of bed.beaches) {
    const landM = landWidthM(bed, beach);
    if (beach.side === "+x") extent.maxXM += landM;
    else if (beach.side === "-x") extent.minXM -= landM;
    else if (beach.side === "+z") extent.maxZM += landM;
    else extent.minZM -= landM;
  }
  return extent;
}

/** For bed.glsl: widths and depths at the sides +x, -x, +z, -z; a side without a beach has the scene's depth. */
export function bedUniformValues(bed: Bed): { widthsM: number[]; shoreDepthsM: number[] } {
  const beachOf = (side: SideName): BeachInfo | undefined => bed.beaches.find((beach) => beach.side === side);
  return {
    widthsM: kSides.map((side) => beachOf(side)?.widthM ?? 1),
    shoreDepthsM: kSides.map((side) => beachOf(side)?.shoreDepthM ?? bed.depthM),
  };
}

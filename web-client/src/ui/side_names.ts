// What is at each side of the water, so that a list names a side by what one sees there.
import type { GreetingInfo } from "../codec/greeting";
import { kSideNames, type SideName } from "../codec/scene_info";

export type SideWhat = "beach" | "sea" | "quay" | "wall" | "end";
/** As seen from the view from above and from the side. */
export type SideWhere = "left" | "right" | "near" | "far";

const kWhere: Record<SideName, SideWhere> = { "+x": "right", "-x": "left", "+z": "near", "-z": "far" };

type Surrounded = Pick<GreetingInfo, "wave" | "beaches" | "setting">;

function whatIsAt(side: SideName, { wave, beaches, setting }: Surrounded): SideWhat {
  if (beaches.some((beach) => beach.side === side)) return "beach";
  const isClosed = wave === undefined || wave.sides[side] === "closed";
  if (setting === "openSea") return isClosed ? "quay" : "sea";
  return isClosed ? "wall" : "end";
}

/** `where` is undefined where there is only one side of this kind. */
export function sidesOf(surrounded: Surrounded): { side: SideName; what: SideWhat; where: SideWhere | undefined }[] {
  const whats = kSideNames.map((side) => whatIsAt(side, surrounded));
  return kSideNames.map((side, at) => {
    const what = whats[at]!;
    return { side, what, where: whats.filter((other) => other === what).length > 1 ? kWhere[side] : undefined };
  });
}

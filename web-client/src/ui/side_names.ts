// What is at each side of the water, so that a list names a side by what one sees there.
import type { GreetingInfo } from "../../client/codec/greeting";
import { hasRockyShores, kSideNames, type SideName } from "../../client/codec/scene_info";

export type SideWhat = "beach" | "sea" | "rocks" | "quay" | "wall" | "end";
/** As seen from the first view. */
export type SideWhere = "left" | "right" | "near" | "far";
/** Where something is in the picture. */
export type PictureSide = "left" | "middle" | "right";

/** Sides in the order of their headings, from +x toward +z, and what is there for a camera that looks along +x. */
const kRound: readonly SideName[] = ["+x", "+z", "-x", "-z"];
const kWhere: readonly SideWhere[] = ["far", "right", "near", "left"];
const kUsualHeadingRad = -Math.PI / 2;

type Surrounded = Pick<GreetingInfo, "wave" | "beaches" | "setting"> & { firstView?: GreetingInfo["firstView"] };

function whatIsAt(side: SideName, { wave, beaches, setting }: Surrounded): SideWhat {
  if (beaches.some((beach) => beach.side === side)) return "beach";
  const isClosed = wave === undefined || wave.sides[side] === "closed";
  if (setting === "openSea") return !isClosed ? "sea" : hasRockyShores(beaches) ? "rocks" : "quay";
  return isClosed ? "wall" : "end";
}

/** `where` is undefined where there is only one side of this kind. */
export function sidesOf(surrounded: Surrounded): { side: SideName; what: SideWhat; where: SideWhere | undefined }[] {
  const whats = kSideNames.map((side) => whatIsAt(side, surrounded));
  const turns = Math.round((surrounded.firstView?.headingRad ?? kUsualHeadingRad) / (Math.PI / 2));
  const whereIs = (side: SideName): SideWhere => kWhere[(((kRound.indexOf(side) - turns) % 4) + 4) % 4]!;
  return kSideNames.map((side, at) => {
    const what = whats[at]!;
    return { side, what, where: whats.filter((other) => other === what).length > 1 ? whereIs(side) : undefined };
  });
}

// What the tools Float and Throw send: an object that is dropped, a stone that flies. Pure.
import type { GreetingInfo } from "../../client/codec/greeting";
import { kFloaterRanges } from "../../client/gen/ranges";
import { FloaterKind } from "../../client/gen/spindrift/v1/scene_pb";
import type { CommandAction } from "../../client/session/events";
import { kFloaterKinds, type FloaterKindName } from "../../client/codec/floaters";
import { clamp } from "../scene/maths/interpolate";
import { clampTo } from "./effect_limits";
import type { ToolName, ToolScale, WaterPlace } from "./tools";
import { kTexts } from "./texts";

type Water = Pick<GreetingInfo, "waterExtents" | "sideM" | "widthM" | "gravityMps2">;
type Velocity = readonly [x: number, y: number, z: number];

/** Size at 100 %, as a share of the shorter side within bounds [m]; never more than the largest share. */
const kSizes = { float: { sides: 0.04, limitsM: [0.2, 1.5] }, throw: { sides: 0.015, limitsM: [0.1, 0.5] } } as const;
const kLargestSides = 0.2;
/** An object's middle is at least half of this many sizes from a side, a little more than the server asks for. */
const kSideGapSizes = 1.02;
/** Height of a dropped object's middle over the water, in sizes. */
const kDropSizes = 0.9;
/** Where a stone is released over the water, as a share of the shorter side within bounds [m]. */
const kRelease = { sides: 0.05, limitsM: [0.15, 1.5] } as const;
/** Times of a flick that count as its duration: a shorter one is a twitch, in a longer one the hand has aimed. */
const kFlickS = [0.12, 0.6] as const;
/** Upward over horizontal speed of a flick: low enough for a flat stone. */
const kFlickRise = 0.3;
/** A flick flies about so many sides at most. */
const kFarthestSides = 0.7;
/** A toss comes from so far toward the camera, as a share of the shorter side within bounds [m]. */
const kToss = { sides: 0.15, limitsM: [0.4, 4] } as const;
const kEarthMps2 = 9.81;
const kArcPoints = 20;

const gravityOf = ({ gravityMps2 }: Water): number => gravityMps2 || kEarthMps2;
const shareOf = (water: Water, { sides, limitsM }: { sides: number; limitsM: readonly [number, number] }): number => clamp(sides * water.waterExtents.sideM, ...limitsM);

/** Names for densities over the water's, up to these. */
const kDensityNames: readonly (readonly [upTo: number, name: keyof typeof kTexts.densities])[] = [[0, "own"], [0.4, "balsa"], [0.8, "oak"], [0.97, "ice"], [Infinity, "stone"]];

/** What a density over the water's is like. */
export function densityName(densityRatio: number): string {
  return kTexts.densities[kDensityNames.find(([upTo]) => densityRatio <= upTo)![1]];
}

/** Size of the tool's objects; undefined for a tool without objects. */
export function floaterSizeM(tool: ToolName, water: Water, { sizeRatio }: ToolScale): number | undefined {
  if (tool !== "float" && tool !== "throw") return undefined;
  const sizeM = Math.min(sizeRatio * shareOf(water, kSizes[tool]), kLargestSides * water.waterExtents.sideM);
  return clampTo(sizeM, kFloaterRanges.sizeM);
}

function wireKind(kind: FloaterKindName): FloaterKind {
  return (kFloaterKinds.indexOf(kind) + 1) as FloaterKind;
}

/** The nearest position that an object of this size can have: half of it from the sides. */
function inside({ xM, zM }: WaterPlace, sizeM: number, { sideM, widthM }: Water): WaterPlace {
  const within = (atM: number, lengthM: number): number => clamp(atM, -(lengthM - kSideGapSizes * sizeM) / 2, (lengthM - kSideGapSizes * sizeM) / 2);
  return { xM: within(xM, sideM), zM: within(zM, widthM) };
}

/** An object that falls onto the water; `levelM`: of the water there. `densityRatio` 0: what suits its kind. */
export function dropOf(kind: FloaterKindName, place: WaterPlace, levelM: number, sizeM: number, densityRatio: number, headingDeg: number, water: Water): CommandAction {
  return { case: "spawnFloater", value: { floater: { kind: wireKind(kind), ...inside(place, sizeM, water), yM: levelM + kDropSizes * sizeM, sizeM, densityRatio, headingDeg } } };
}

/** A stone at its release. */
export interface Throw {
  from: WaterPlace;
  yM: number;
  velocityMps: Velocity;
}

export function throwOf({ from, yM, velocityMps }: Throw, sizeM: number, water: Water): CommandAction {
  const [velocityXMps, velocityYMps, velocityZMps] = velocityMps.map((each) => clampTo(each, kFloaterRanges.velocityXMps));
  return { case: "spawnFloater", value: { floater: { kind: FloaterKind.STONE, ...inside(from, sizeM, water), yM, sizeM, velocityXMps, velocityYMps, velocityZMps } } };
}

/** The throw of a flick from one place to another that took `heldS`; undefined if it did not move. */
export function flickOf(from: WaterPlace, to: WaterPlace, heldS: number, levelM: number, water: Water, { strengthRatio }: ToolScale): Throw | undefined {
  const wayM = Math.hypot(to.xM - from.xM, to.zM - from.zM);
  if (wayM < 1e-3) return undefined;
  const fastestMps = Math.min(Math.sqrt(kFarthestSides * water.waterExtents.longM * gravityOf(water)), kFloaterRanges.velocityXMps.max);
  const speedMps = Math.min((strengthRatio * wayM) / clamp(heldS, ...kFlickS), fastestMps);
  const along = (toM: number, fromM: number): number => (speedMps * (toM - fromM)) / wayM;
  return { from, yM: levelM + shareOf(water, kRelease), velocityMps: [along(to.xM, from.xM), kFlickRise * speedMps, along(to.zM, from.zM)] };
}

/** A gentle throw from the camera's side that comes down where one wants it. */
export function tossTo(target: WaterPlace, camera: WaterPlace, levelM: number, water: Water): Throw {
  const awayM = Math.hypot(camera.xM - target.xM, camera.zM - target.zM) || 1;
  const backM = Math.min(shareOf(water, kToss), awayM);
  const back = { xM: target.xM + (backM * (camera.xM - target.xM)) / awayM, zM: target.zM + (backM * (camera.zM - target.zM)) / awayM };
  const from = inside(back, 0.04 * water.waterExtents.sideM, water);
  const highM = shareOf(water, kRelease);
  const forS = 0.25 + 0.4 * Math.sqrt(backM);
  return { from, yM: levelM + highM, velocityMps: [(target.xM - from.xM) / forS, (gravityOf(water) * forS) / 2 - highM / forS, (target.zM - from.zM) / forS] };
}

/** Points of a throw's path until it is at `levelM`, the last one where it lands. */
export function arcOf({ from, yM, velocityMps: [x, y, z] }: Throw, levelM: number, water: Water): (WaterPlace & { yM: number })[] {
  const gravityMps2 = gravityOf(water);
  const endS = (y + Math.sqrt(Math.max(y * y + 2 * gravityMps2 * (yM - levelM), 0))) / gravityMps2;
  return Array.from({ length: kArcPoints + 1 }, (_, k) => {
    const atS = (endS * k) / kArcPoints;
    return { xM: from.xM + x * atS, zM: from.zM + z * atS, yM: yM + y * atS - (gravityMps2 * atS * atS) / 2 };
  });
}

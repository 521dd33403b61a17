// Where the water is on the pad's map: metres of the water and pixels of the canvas. Pure.
import { wrapAngle } from "../scene/maths/interpolate";
import type { WaterPlace } from "../ui/tools";

/** Margin round the whole water. */
export const kMarginPx = 10;
/** The boat's map: so many boat lengths along the shorter side, and the boat so far down. */
const kBoatLengthsSeen = 11;
const kBoatDown = 0.6;
/** Least part of the shorter side of the water that the boat's map shows. */
const kLeastSeen = 0.3;

interface SizePx {
  widthPx: number;
  heightPx: number;
}

export interface MapView {
  /** Shown at `middlePx`. */
  centre: WaterPlace;
  middlePx: readonly [x: number, y: number];
  pxPerM: number;
  /** By which the water is turned clockwise: 0 has +x to the right and +z down. */
  turnRad: number;
}

/** The whole water, as large as it fits. */
export function wholeView({ sideM, widthM }: { sideM: number; widthM: number }, { widthPx, heightPx }: SizePx): MapView {
  const pxPerM = Math.min(Math.max(widthPx - 2 * kMarginPx, 1) / sideM, Math.max(heightPx - 2 * kMarginPx, 1) / widthM);
  return { centre: { xM: 0, zM: 0 }, middlePx: [widthPx / 2, heightPx / 2], pxPerM, turnRad: 0 };
}

/** The water round a boat, which looks up. `turnRad`: of the map, which follows the heading with a delay. */
export function boatView(boat: WaterPlace & { lengthM: number }, turnRad: number, waterSideM: number, { widthPx, heightPx }: SizePx): MapView {
  const seenM = Math.max(kBoatLengthsSeen * boat.lengthM, kLeastSeen * waterSideM);
  return { centre: { xM: boat.xM, zM: boat.zM }, middlePx: [widthPx / 2, kBoatDown * heightPx], pxPerM: Math.min(widthPx, heightPx) / seenM, turnRad };
}

/** Turn of a map on which this heading points up. */
export function turnFor(headingRad: number): number {
  return wrapAngle(-headingRad - Math.PI / 2);
}

export function toPx({ centre, middlePx: [x, y], pxPerM, turnRad }: MapView, { xM, zM }: WaterPlace): [x: number, y: number] {
  const [c, s] = [Math.cos(turnRad), Math.sin(turnRad)];
  const [dx, dz] = [(xM - centre.xM) * pxPerM, (zM - centre.zM) * pxPerM];
  return [x + dx * c - dz * s, y + dx * s + dz * c];
}

export function toPlace({ centre, middlePx: [x, y], pxPerM, turnRad }: MapView, xPx: number, yPx: number): WaterPlace {
  const [c, s] = [Math.cos(turnRad), Math.sin(turnRad)];
  const [dx, dy] = [(xPx - x) / pxPerM, (yPx - y) / pxPerM];
  return { xM: centre.xM + dx * c + dy * s, zM: centre.zM - dx * s + dy * c };
}

/** Room that arrows at the edge leave: the headline is above, the stick below, which takes a share of the height. */
const kEdgePx = { side: 26, top: 62 };
const kEdgeBottomShare = 0.28;

/**
 * Returns where the way from the view's middle to a point leaves the map, and its direction there, clockwise from the right; undefined if
 * the map shows the point.
 */
export function edgeOf({ middlePx: [x, y] }: MapView, [toX, toY]: readonly [number, number], { widthPx, heightPx }: SizePx): { xPx: number; yPx: number; angleRad: number } | undefined {
  const [dx, dy] = [toX - x, toY - y];
  const along = (d: number, from: number, low: number, high: number): number => (d > 0 ? (high - from) / d : d < 0 ? (low - from) / d : Infinity);
  const share = Math.min(along(dx, x, kEdgePx.side, widthPx - kEdgePx.side), along(dy, y, kEdgePx.top, (1 - kEdgeBottomShare) * heightPx));
  return share >= 1 ? undefined : { xPx: x + share * dx, yPx: y + share * dy, angleRad: Math.atan2(dy, dx) };
}

/** Returns the nearest position on the water. */
export function ontoWater({ xM, zM }: WaterPlace, { sideM, widthM }: { sideM: number; widthM: number }): WaterPlace {
  const within = (at: number, lengthM: number): number => Math.min(Math.max(at, -0.499 * lengthM), 0.499 * lengthM);
  return { xM: within(xM, sideM), zM: within(zM, widthM) };
}

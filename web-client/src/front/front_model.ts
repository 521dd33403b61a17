// What the front page shows of the rooms, and which of them are live. Pure.
import type { RoomSummary } from "../../client/rest/rooms";

/** So many pictures are live at once. Each is a connection, and a room that somebody is connected to does not sleep. */
const kLiveMaxCount = 12;

type RoomStateName = "running" | "paused" | "asleep";

export function stateOf({ isPaused, isAsleep }: RoomSummary): RoomStateName {
  return isPaused ? "paused" : isAsleep ? "asleep" : "running";
}

/** A card's picture is so much wider than high, as in front.css. */
const kCardAspectRatio = 1.6;
/** Waters of other shapes are cut, but at least so much of the card's side is filled and so much of the water's shown. */
const kLeastShare = 0.45;

/** Returns the width of a water's picture in percent of the card's, for a water that is so much longer than wide. */
export function pictureWidthPercent(aspectRatio: number): number {
  const leastForHeight = (kLeastShare * aspectRatio) / kCardAspectRatio;
  const mostForHeight = aspectRatio / (kLeastShare * kCardAspectRatio);
  return Math.round(100 * Math.max(leastForHeight, Math.min(1, mostForHeight)));
}

/** Returns the rooms whose pictures are to be live, of those in the window: none while the page is hidden; beyond the bound those that are
 *  live already, then those that come first. */
export function chooseLive(inWindow: readonly string[], live: ReadonlySet<string>, isPageHidden: boolean): string[] {
  if (isPageHidden) return [];
  return [...inWindow.filter((name) => live.has(name)), ...inWindow.filter((name) => !live.has(name))].slice(0, kLiveMaxCount);
}

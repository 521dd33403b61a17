// Where a label over a point of the water is on the page.
import { Matrix4, Vector4 } from "three";

import type { PixelRect } from "../scene/camera/framing";

/** Half the width and the height that a tag needs. */
const kHalfWidthPx = 44;
const kHeightPx = 26;

export interface TagPlace {
  xPx: number;
  yPx: number;
  /** Distance along the view. */
  awayM: number;
}

/** Returns whether tags at these places do not lie over one another. */
export function areApart(a: TagPlace, b: TagPlace): boolean {
  return Math.abs(a.xPx - b.xPx) >= 2 * kHalfWidthPx || Math.abs(a.yPx - b.yPx) >= kHeightPx;
}

const scratch = new Vector4();

/** Returns where a point is on the page; undefined behind the camera, outside the window, or where a panel covers the tag. */
export function tagPlace(seen: Matrix4, point: readonly [number, number, number], widthPx: number, heightPx: number, covered: readonly PixelRect[]): TagPlace | undefined {
  const { x, y, w } = scratch.set(...point, 1).applyMatrix4(seen);
  if (!(w > 1e-6)) return undefined;
  const xPx = (0.5 + (0.5 * x) / w) * widthPx;
  const yPx = (0.5 - (0.5 * y) / w) * heightPx;
  if (!(xPx > 0 && xPx < widthPx && yPx > kHeightPx && yPx < heightPx)) return undefined;
  const hides = ({ leftPx, topPx, rightPx, bottomPx }: PixelRect): boolean =>
    xPx + kHalfWidthPx > leftPx && xPx - kHalfWidthPx < rightPx && yPx > topPx && yPx - kHeightPx < bottomPx;
  return covered.some(hides) ? undefined : { xPx, yPx, awayM: w };
}

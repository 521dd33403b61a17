// The ray from the camera through a position of the window, and the water that it meets.
import { Vector3 } from "three";

import { pickWater, type Ray } from "../scene/frames/pick";
import { toDeviceCoordinates } from "../ui/tap";
import type { WaterPlace } from "../ui/tools";
import type { Display } from "./display";

/** Where water is looked for, as shares of the picture's height: downwards from the middle, which may show the sky. */
const kMiddleShares = [0.5, 0.6, 0.7, 0.8, 0.9];

export function rayAt({ canvas, scene: { camera } }: Display, xPx: number, yPx: number): Ray {
  const at = toDeviceCoordinates(xPx, yPx, canvas.getBoundingClientRect());
  const direction = new Vector3(at.x, at.y, 0.5).unproject(camera).sub(camera.position).normalize();
  return { originM: camera.position.toArray(), direction: direction.toArray() };
}

/** Undefined where there is no water. */
export function waterUnder(display: Display, xPx: number, yPx: number): WaterPlace | undefined {
  const shape = display.scene.shape();
  return shape && pickWater(rayAt(display, xPx, yPx), shape);
}

/** The water in the middle of the part of the picture that nothing covers, or the next below it; undefined if no water is seen. */
export function waterInMiddle(display: Display): WaterPlace | undefined {
  const { leftPx, topPx, rightPx, bottomPx } = display.freePart;
  for (const share of kMiddleShares) {
    const place = waterUnder(display, (leftPx + rightPx) / 2, topPx + share * (bottomPx - topPx));
    if (place) return place;
  }
  return undefined;
}

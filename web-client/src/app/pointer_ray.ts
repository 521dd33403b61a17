// The ray from the camera through a position of the window.
import { Vector3 } from "three";

import type { Ray } from "../scene/frames/pick";
import { toDeviceCoordinates } from "../ui/tap";
import type { Display } from "./display";

export function rayAt({ canvas, scene: { camera } }: Display, xPx: number, yPx: number): Ray {
  const at = toDeviceCoordinates(xPx, yPx, canvas.getBoundingClientRect());
  const direction = new Vector3(at.x, at.y, 0.5).unproject(camera).sub(camera.position).normalize();
  return { originM: camera.position.toArray(), direction: direction.toArray() };
}

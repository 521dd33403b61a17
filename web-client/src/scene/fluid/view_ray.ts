// The view rays of a camera's pixels, for passes that find positions from distances. Pure: no renderer.
import type { PerspectiveCamera, Vector4 } from "three";

/** Writes the scale (x, y) and the offset (z, w) that turn normalized device coordinates into the view ray (x, y, -1). */
export function viewRay(camera: PerspectiveCamera, out: Vector4): Vector4 {
  const at = camera.projectionMatrix.elements;
  return out.set(1 / at[0]!, 1 / at[5]!, at[8]! / at[0]!, at[9]! / at[5]!);
}

// The part of space that the map of shadows holds, seen along the light: the smallest box that covers the water and what stands round it. Pure.
import { Matrix4, Vector3 } from "three";

/** A box over the square: its half length along x and z, and its lowest and highest height [m]. */
export interface ShadowBox {
  halfM: number;
  lowM: number;
  highM: number;
}

const kUp = new Vector3(0, 1, 0);

/**
 * Returns the matrix from world positions to the map, 0..1 along each axis: columns, rows, and distance from the light. It depends on the box and
 * the light only, so that the edges of a shadow do not move with the camera. `towardLight`: a unit vector that points above the horizon.
 */
export function shadowMatrix({ halfM, lowM, highM }: ShadowBox, towardLight: Vector3): Matrix4 {
  const right = new Vector3().crossVectors(kUp, towardLight);
  if (right.lengthSq() < 1e-8) right.set(1, 0, 0);
  right.normalize();
  const up = new Vector3().crossVectors(towardLight, right);
  const away = towardLight.clone().negate();
  const rows = [right, up, away].map((axis) => {
    const reachM = halfM * (Math.abs(axis.x) + Math.abs(axis.z));
    const fromM = -reachM + Math.min(axis.y * lowM, axis.y * highM);
    const toM = reachM + Math.max(axis.y * lowM, axis.y * highM);
    return [axis.x, axis.y, axis.z, -fromM].map((each) => each / (toM - fromM));
  });
  const [u, v, depth] = rows as [number[], number[], number[]];
  return new Matrix4().set(u[0]!, u[1]!, u[2]!, u[3]!, v[0]!, v[1]!, v[2]!, v[3]!, depth[0]!, depth[1]!, depth[2]!, depth[3]!, 0, 0, 0, 1);
}

/** Returns the projection that draws the map of `toMap`: its 0..1 as -1..1. */
export function toClip(toMap: Matrix4): Matrix4 {
  return new Matrix4().set(2, 0, 0, -1, 0, 2, 0, -1, 0, 0, 2, -1, 0, 0, 0, 1).multiply(toMap);
}

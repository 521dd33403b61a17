// Where a camera may be: above the water everywhere, and in the water of the square where it is deep enough. Pure.
import type { Vector3 } from "three";

import type { GreetingInfo } from "../../../client/codec/greeting";
import type { ObstacleInfo } from "../../../client/codec/scene_info";
import { clearanceM } from "../landscape/clearance";
import { coastHeightM } from "../landscape/coast";
import { bedOf, groundHeightM, isTank } from "../landscape/terrain";
import { clamp } from "../maths/interpolate";

/** Least depth for a camera, and its distance from ground, walls and obstacles, in near planes. */
const kLeastDepthNears = 4;
const kClearNears = 1.6;
/** Outside the square and over shallow water a camera stays above the still water by this many near planes. */
const kAboveNears = 3;
/** A tank is seen from outside down to this share of its depth. */
const kOutsideDepths = 0.5;

export interface DiveWater {
  sideM: number;
  widthM: number;
  depthM: number;
  /** Distance of the camera's near plane. */
  nearM: number;
  /** Least height of a camera outside the square. */
  outsideM: number;
  obstacles: readonly ObstacleInfo[];
  /** Height of the ground; y = 0 at the still water. */
  groundM(xM: number, zM: number): number;
}

/** Returns the water into which a camera may dive; undefined: none is deep enough. */
export function diveWater(greeting: GreetingInfo, nearM: number): DiveWater | undefined {
  const { sideM, widthM, wave, setting, obstacles } = greeting;
  if (!wave || wave.depthM < kLeastDepthNears * nearM) return undefined;
  const bed = bedOf(greeting);
  const coast = { bed, sides: wave.sides };
  const groundM = setting === "openSea" ? (xM: number, zM: number): number => coastHeightM(coast, xM, zM) : (xM: number, zM: number): number => groundHeightM(bed, xM, zM);
  const outsideM = isTank(greeting) ? -kOutsideDepths * wave.depthM : kAboveNears * nearM;
  return { sideM, widthM, depthM: wave.depthM, nearM, outsideM, obstacles, groundM };
}

/** Returns the distance from a position to the nearest side of the square; negative outside. */
function fromSidesM({ sideM, widthM }: DiveWater, xM: number, zM: number): number {
  return Math.min(sideM / 2 - Math.abs(xM), widthM / 2 - Math.abs(zM));
}

/** Moves a camera to the nearest position where it may be. Returns whether it was moved. */
export function keepClear(water: DiveWater, positionM: Vector3): boolean {
  const { nearM, outsideM, sideM, widthM, groundM, obstacles } = water;
  const clearM = kClearNears * nearM;
  const from = positionM.clone();
  if (positionM.y < 0 && fromSidesM(water, positionM.x, positionM.z) > -clearM) {
    // A camera in the water does not leave the square.
    positionM.x = clamp(positionM.x, clearM - sideM / 2, sideM / 2 - clearM);
    positionM.z = clamp(positionM.z, clearM - widthM / 2, widthM / 2 - clearM);
  }
  for (const obstacle of obstacles) {
    if (positionM.y > obstacle.heightM + clearM) continue;
    const insideM = clearM - clearanceM(obstacle, positionM.x, positionM.z);
    if (insideM <= 0) continue;
    // Outward is where the distance grows.
    const stepM = 0.01 * clearM;
    const dx = clearanceM(obstacle, positionM.x + stepM, positionM.z) - clearanceM(obstacle, positionM.x - stepM, positionM.z);
    const dz = clearanceM(obstacle, positionM.x, positionM.z + stepM) - clearanceM(obstacle, positionM.x, positionM.z - stepM);
    const length = Math.hypot(dx, dz);
    positionM.x += insideM * (length > 0 ? dx / length : 1);
    positionM.z += insideM * (length > 0 ? dz / length : 0);
  }
  const groundAtM = groundM(positionM.x, positionM.z);
  const isOutside = fromSidesM(water, positionM.x, positionM.z) <= 0;
  const isDeep = !isOutside && groundAtM < -kLeastDepthNears * nearM;
  positionM.y = Math.max(positionM.y, isDeep ? groundAtM + clearM : isOutside ? Math.max(groundAtM + clearM, outsideM) : Math.max(groundAtM + clearM, kAboveNears * nearM));
  return !positionM.equals(from);
}

/** The view from below: depth of the eye as a share of the water's, and how far ahead it looks, in sides. */
const kEyeDepths = 0.62;
const kAheadSides = 0.12;
/** Positions that are tried for it, in half sides of the square. */
const kTried = [-0.6, -0.4, -0.2, 0, 0.2, 0.4, 0.6];
/** Clearance beyond which a position is not better, in sides. */
const kEnoughSides = 0.2;

/**
 * Returns a camera in the water that looks along `direction`: in deep water, with room ahead, and near the middle. `direction` is a unit vector.
 */
export function diveView(water: DiveWater, direction: Vector3): { positionM: Vector3; targetM: Vector3 } {
  const { sideM, widthM, depthM, obstacles, groundM } = water;
  const positionM = direction.clone().setScalar(0);
  let best = Number.NEGATIVE_INFINITY;
  for (const i of kTried)
    for (const k of kTried) {
      const [xM, zM] = [(i * sideM) / 2, (k * widthM) / 2];
      const aheadM = [0, 0.5, 1].map((share) => ({ xM: xM + share * kAheadSides * sideM * direction.x, zM: zM + share * kAheadSides * sideM * direction.z }));
      const roomM = Math.min(...aheadM.flatMap((at) => [fromSidesM(water, at.xM, at.zM), ...obstacles.map((obstacle) => clearanceM(obstacle, at.xM, at.zM))]));
      const deep = Math.min(-groundM(xM, zM) / depthM, 1);
      const score = 2 * deep + Math.min(roomM / sideM / kEnoughSides, 1) - 0.5 * Math.hypot(i, k);
      if (score <= best) continue;
      best = score;
      positionM.set(xM, Math.max(-kEyeDepths, -deep) * depthM, zM);
    }
  keepClear(water, positionM);
  return { positionM, targetM: positionM.clone().addScaledVector(direction, kAheadSides * sideM) };
}

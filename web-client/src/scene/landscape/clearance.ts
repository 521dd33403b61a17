// Distances to obstacles. Pure.
import type { ObstacleInfo } from "../../../client/codec/scene_info";

/** Returns the distance from a point to the outline of an obstacle; negative inside. */
export function clearanceM(obstacle: ObstacleInfo, xM: number, zM: number): number {
  const dx = xM - obstacle.xM;
  const dz = zM - obstacle.zM;
  if (obstacle.shape === "rock") return Math.hypot(dx, dz) - obstacle.radiusM;
  const [c, s] = [Math.cos(obstacle.headingRad), Math.sin(obstacle.headingRad)];
  const outX = Math.abs(dx * c + dz * s) - obstacle.lengthM / 2;
  const outZ = Math.abs(dz * c - dx * s) - obstacle.widthM / 2;
  return Math.hypot(Math.max(outX, 0), Math.max(outZ, 0)) + Math.min(Math.max(outX, outZ), 0);
}

/** Returns true inside the outline that an obstacle has at the still water. */
export function isCovered(obstacles: readonly ObstacleInfo[], xM: number, zM: number): boolean {
  return obstacles.some((obstacle) => clearanceM(obstacle, xM, zM) < 0);
}

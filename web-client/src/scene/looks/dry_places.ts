// Places of the water's square where an obstacle stands in it. Pure.
import type { ObstacleInfo } from "../../codec/scene_info";

/** Returns true inside the outline that an obstacle has at the still water. */
export function isCovered(obstacles: readonly ObstacleInfo[], xM: number, zM: number): boolean {
  return obstacles.some((obstacle) => {
    const [dx, dz] = [xM - obstacle.xM, zM - obstacle.zM];
    if (obstacle.shape === "rock") return dx * dx + dz * dz < obstacle.radiusM ** 2;
    const [c, s] = [Math.cos(obstacle.headingRad), Math.sin(obstacle.headingRad)];
    return Math.abs(dx * c + dz * s) < obstacle.lengthM / 2 && Math.abs(dz * c - dx * s) < obstacle.widthM / 2;
  });
}

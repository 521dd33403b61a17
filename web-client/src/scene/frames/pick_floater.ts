// Finds the object under a pointer: a ray against bounding spheres. Pure.
import type { FloaterPose } from "../../../client/codec/floaters";
import { kRadiusSizes } from "./floaters";
import type { Ray } from "./pick";

/**
 * Returns the object that the ray meets first; if it meets none, the one that it passes nearest to, within `nearRad` seen from the eye.
 * Only those that `accepts` takes count.
 */
export function pickFloater({ originM, direction }: Ray, floaters: readonly FloaterPose[], nearRad: number, accepts: (pose: FloaterPose) => boolean): FloaterPose | undefined {
  let best: FloaterPose | undefined;
  let [bestIsHit, bestScore] = [false, Infinity];
  for (const pose of floaters) {
    const [x, y, z] = [pose.xM - originM[0], pose.yM - originM[1], pose.zM - originM[2]];
    const alongM = x * direction[0] + y * direction[1] + z * direction[2];
    if (alongM <= 0) continue;
    const passM = Math.sqrt(Math.max(x * x + y * y + z * z - alongM * alongM, 0));
    const radiusM = kRadiusSizes[pose.kind] * pose.sizeM;
    const isHit = passM <= radiusM;
    if (!isHit && passM > alongM * Math.tan(nearRad)) continue;
    const score = isHit ? alongM - Math.sqrt(radiusM * radiusM - passM * passM) : (passM - radiusM) / alongM;
    if ((isHit === bestIsHit ? score >= bestScore : bestIsHit) || !accepts(pose)) continue;
    [best, bestIsHit, bestScore] = [pose, isHit, score];
  }
  return best;
}

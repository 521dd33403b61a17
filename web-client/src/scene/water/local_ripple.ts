// The dents that one's own fingers press, drawn before the server's water shows them: from where a finger is now back to where it was when the
// water shown was simulated. There the server's dent takes over, so nothing jumps. A finger that rests or is lifted lets its dent go.
import { Vector4, type IUniform } from "three";

import { clamp, smooth } from "../maths/interpolate";

/** Most dents of a picture; the same number is in elevation.frag. */
const kDentsMax = 16;
/** Dents along the way that the server does not show yet, and their shares of the depth, the newest first. */
const kShares = [0.4, 0.3, 0.2, 0.1];
const kPressS = 0.04;
const kReleaseS = 0.25;
/** A dent fades while its finger rests, as water flows back under it. */
const kRestS = 0.4;

interface Place {
  atS: number;
  xM: number;
  zM: number;
}

interface Finger {
  radiusM: number;
  depthM: number;
  beganS: number;
  liftedS: number;
  /** Oldest first; never empty. */
  path: Place[];
}

export class LocalRipple {
  /** Position x and z [m], radius [m], elevation in the middle [m]. */
  readonly dents: IUniform<Vector4[]> = { value: Array.from({ length: kDentsMax }, () => new Vector4(0, 0, 1, 0)) };
  readonly count: IUniform<number> = { value: 0 };
  private readonly fingers = new Map<number, Finger>();

  /** `nowS`: time of the pictures. */
  press(pointerId: number, xM: number, zM: number, { radiusM, depthM }: { radiusM: number; depthM: number }, nowS: number): void {
    this.fingers.set(pointerId, { radiusM, depthM, beganS: nowS, liftedS: Infinity, path: [{ atS: nowS, xM, zM }] });
  }

  move(pointerId: number, xM: number, zM: number, nowS: number): void {
    this.fingers.get(pointerId)?.path.push({ atS: nowS, xM, zM });
  }

  lift(pointerId: number, nowS: number): void {
    const finger = this.fingers.get(pointerId);
    if (finger) finger.liftedS = Math.min(finger.liftedS, nowS);
  }

  /** Where the fingers are that are down, by pointer. */
  down(): Map<number, Place> {
    return new Map([...this.fingers].filter(([, { liftedS }]) => liftedS === Infinity).map(([pointerId, { path }]) => [pointerId, path.at(-1)!]));
  }

  /** Sets the dents of a picture. `behindS`: age of the water that it shows. */
  update(nowS: number, behindS: number): void {
    let count = 0;
    for (const [pointerId, finger] of this.fingers) {
      const { path, radiusM } = finger;
      while (path.length > 1 && path[1]!.atS < nowS - behindS) path.shift();
      const level = smooth(clamp((nowS - finger.beganS) / kPressS, 0, 1)) * (1 - smooth(clamp((nowS - finger.liftedS) / kReleaseS, 0, 1)));
      if (nowS - finger.liftedS > kReleaseS) {
        this.fingers.delete(pointerId);
        continue;
      }
      const restS = nowS - path.at(-1)!.atS;
      const depthM = finger.depthM * level * Math.exp(-Math.max(restS - behindS, 0) / kRestS);
      for (const [k, share] of kShares.entries()) {
        if (count === kDentsMax) break;
        const { xM, zM } = placeAt(path, nowS - (k / kShares.length) * behindS);
        this.dents.value[count++]!.set(xM, zM, radiusM, -share * depthM);
      }
    }
    this.count.value = count;
  }
}

function placeAt(path: readonly Place[], atS: number): Place {
  for (let k = path.length - 1; k > 0; --k) {
    const from = path[k - 1]!;
    const to = path[k]!;
    if (from.atS > atS) continue;
    const share = clamp((atS - from.atS) / Math.max(to.atS - from.atS, 1e-6), 0, 1);
    return { atS, xM: from.xM + share * (to.xM - from.xM), zM: from.zM + share * (to.zM - from.zM) };
  }
  return path[0]!;
}

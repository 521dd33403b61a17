// Frames of objects in the water: unpacking, and interpolation between two of them. Pure.
import { normalize, readFloaters, type FloaterKindName, type FloaterPose } from "../../../client/codec/floaters";
import type { FloatersFrame } from "../../net/messages";
import { clamp } from "../maths/interpolate";

/** Radius of the sphere round the whole object, in sizes. */
export const kRadiusSizes: Record<FloaterKindName, number> = { crate: 0.87, ball: 0.5, barrel: 0.6, plank: 0.52, duck: 0.52, buoy: 0.58, raft: 0.61, stone: 0.5 };

/** One unpacked frame. */
export interface FloatersState {
  timeS: number;
  stateId: bigint;
  floaters: FloaterPose[];
}

function makePose(): FloaterPose {
  return { floaterId: 0, kind: "crate", xM: 0, yM: 0, zM: 0, turn: [0, 0, 0, 1], sizeM: 0, isHeld: false };
}

export function unpackFloaters(frame: FloatersFrame): FloatersState {
  return { timeS: frame.timeS, stateId: frame.stateId, floaters: readFloaters(new DataView(frame.buffer), frame.count, frame.quantumM) };
}

/**
 * Interpolates the objects of `from` toward `to`, writes them to `poses` and returns their count. `poses` grows to the largest count
 * seen and is reused. An object that is not in `to` stays where it is, and so does one that moves by more than half of the water: it
 * left one periodic side and came in at the other.
 */
export function mixFloaters(from: FloatersState, to: FloatersState, mix: number, water: { sideM: number; widthM: number }, poses: FloaterPose[]): number {
  const count = from.floaters.length;
  while (poses.length < count) poses.push(makePose());
  let next = 0;
  for (let i = 0; i < count; ++i) {
    const a = from.floaters[i]!;
    const at = indexOf(to.floaters, a.floaterId, next);
    if (at >= 0) next = at + 1;
    const b = to.floaters[at] ?? a;
    const jumps = Math.abs(b.xM - a.xM) > water.sideM / 2 || Math.abs(b.zM - a.zM) > water.widthM / 2;
    mixPose(a, b, jumps ? 0 : clamp(mix, 0, 1), poses[i]!);
  }
  return count;
}

function mixPose(a: FloaterPose, b: FloaterPose, share: number, out: FloaterPose): void {
  out.floaterId = a.floaterId;
  out.kind = a.kind;
  out.xM = a.xM + (b.xM - a.xM) * share;
  out.yM = a.yM + (b.yM - a.yM) * share;
  out.zM = a.zM + (b.zM - a.zM) * share;
  // A quaternion and its negative are the same rotation: the nearer one is the shorter way.
  const toward = a.turn[0] * b.turn[0] + a.turn[1] * b.turn[1] + a.turn[2] * b.turn[2] + a.turn[3] * b.turn[3] < 0 ? -share : share;
  for (let k = 0; k < 4; ++k) out.turn[k] = a.turn[k]! * (1 - share) + b.turn[k]! * toward;
  normalize(out.turn);
  out.sizeM = a.sizeM;
  out.isHeld = b.isHeld;
}

/** Looks first from `likelyAt` on: objects keep their order, and few of them come or go between two frames. */
function indexOf(floaters: readonly FloaterPose[], floaterId: number, likelyAt: number): number {
  const count = floaters.length;
  for (let k = 0; k < count; ++k) {
    const at = (likelyAt + k) % count;
    if (floaters[at]!.floaterId === floaterId) return at;
  }
  return -1;
}

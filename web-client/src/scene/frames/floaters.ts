// Frames of objects in the water: unpacking, and interpolation between two of them. Pure.
import { kFloaterBytes } from "../../codec/frame_types";
import type { FloatersFrame } from "../../net/messages";
import { clamp } from "../maths/interpolate";

/** In the order of FloaterKind in scene.proto, from 1 on. */
export const kFloaterKinds = ["crate", "ball", "barrel", "plank", "duck", "buoy", "raft", "stone"] as const;
export type FloaterKindName = (typeof kFloaterKinds)[number];

/** Radius of the sphere round the whole object, in sizes. */
export const kRadiusSizes: Record<FloaterKindName, number> = { crate: 0.87, ball: 0.5, barrel: 0.6, plank: 0.52, duck: 0.52, buoy: 0.58, raft: 0.61, stone: 0.5 };

export interface FloaterPose {
  floaterId: number;
  kind: FloaterKindName;
  /** Middle. */
  xM: number;
  yM: number;
  zM: number;
  /** Rotation from the object's own axes to the water's: a unit quaternion x, y, z, w. */
  turn: [number, number, number, number];
  /** Longest extent. */
  sizeM: number;
  isHeld: boolean;
}

/** One unpacked frame. */
export interface FloatersState {
  timeS: number;
  stateId: bigint;
  floaters: FloaterPose[];
}

const kHeldFlag = 1;

function makePose(): FloaterPose {
  return { floaterId: 0, kind: "crate", xM: 0, yM: 0, zM: 0, turn: [0, 0, 0, 1], sizeM: 0, isHeld: false };
}

/** Makes the quaternion a unit one; no rotation if it has no length. */
function normalize(turn: FloaterPose["turn"]): FloaterPose["turn"] {
  const length = Math.hypot(...turn);
  if (length < 1e-6) turn.fill(0, 0, 3).fill(1, 3);
  else for (let k = 0; k < 4; ++k) turn[k]! /= length;
  return turn;
}

export function unpackFloaters(frame: FloatersFrame): FloatersState {
  const view = new DataView(frame.buffer);
  const { quantumM } = frame;
  const floaters: FloaterPose[] = [];
  for (let at = 0; at < frame.count * kFloaterBytes; at += kFloaterBytes)
    floaters.push({
      floaterId: view.getUint32(at, true),
      xM: view.getInt32(at + 4, true) * quantumM,
      yM: view.getInt32(at + 8, true) * quantumM,
      zM: view.getInt32(at + 12, true) * quantumM,
      turn: normalize([view.getInt16(at + 16, true), view.getInt16(at + 18, true), view.getInt16(at + 20, true), view.getInt16(at + 22, true)]),
      sizeM: view.getUint16(at + 24, true) / 100,
      // A kind that only a newer server knows looks like a crate.
      kind: kFloaterKinds[view.getUint8(at + 26) - 1] ?? "crate",
      isHeld: (view.getUint8(at + 27) & kHeldFlag) !== 0,
    });
  return { timeS: frame.timeS, stateId: frame.stateId, floaters };
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

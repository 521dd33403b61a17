// The records of a frame of objects in the water.
import { kFloaterBytes } from "./frame_types";

/** In the order of FloaterKind in scene.proto, from 1 on. */
export const kFloaterKinds = ["crate", "ball", "barrel", "plank", "duck", "buoy", "raft", "stone"] as const;
export type FloaterKindName = (typeof kFloaterKinds)[number];

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

const kHeldFlag = 1;

/** Makes the quaternion a unit one; no rotation if it has no length. */
export function normalize(turn: FloaterPose["turn"]): FloaterPose["turn"] {
  const length = Math.hypot(...turn);
  if (length < 1e-6) turn.fill(0, 0, 3).fill(1, 3);
  else for (let k = 0; k < 4; ++k) turn[k]! /= length;
  return turn;
}

/** Reads `count` records from the beginning of the view. */
export function readFloaters(view: DataView, count: number, quantumM: number): FloaterPose[] {
  const floaters: FloaterPose[] = [];
  for (let at = 0; at < count * kFloaterBytes; at += kFloaterBytes)
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
  return floaters;
}

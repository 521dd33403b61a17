// Bodies frames: unpacking, and interpolation between two of them. Pure.
import { readBodies, type BodyPose } from "../../../client/codec/bodies";
import type { BodiesFrame } from "../../net/messages";
import { mixAngle } from "../maths/interpolate";

/** Most boats of a room, as in the server. */
export const kBoatsMax = 64;

/** One unpacked frame. */
export interface BodiesState {
  timeS: number;
  stateId: bigint;
  bodies: BodyPose[];
}

export function makePose(): BodyPose {
  return { boatId: 0, xM: 0, yM: 0, zM: 0, headingRad: 0, pitchRad: 0, rollRad: 0, speedMps: 0, throttle: 0, rudder: 0 };
}

export function unpackBodies(frame: BodiesFrame): BodiesState {
  return { timeS: frame.timeS, stateId: frame.stateId, bodies: readBodies(new DataView(frame.buffer), frame.count) };
}

/** A longer distance in one frame is a jump: the boat left one periodic side and came in at the other. */
const kJumpM = 3;

/**
 * Interpolates the boats of `from` toward `to`, writes them to `poses` and returns their count. `poses` grows to the
 * largest count seen and is reused. A boat that is not in `to` stays where it is.
 */
export function mixBodies(from: BodiesState, to: BodiesState, mix: number, poses: BodyPose[]): number {
  const count = from.bodies.length;
  while (poses.length < count) poses.push(makePose());
  for (let i = 0; i < count; ++i) {
    const a = from.bodies[i]!;
    const b = bodyOf(to, a.boatId, i) ?? a;
    const pose = poses[i]!;
    const jumps = Math.abs(b.xM - a.xM) + Math.abs(b.zM - a.zM) > kJumpM + 2 * Math.abs(a.speedMps) * (to.timeS - from.timeS);
    const share = jumps ? 0 : mix;
    pose.boatId = a.boatId;
    pose.xM = a.xM + (b.xM - a.xM) * share;
    pose.yM = a.yM + (b.yM - a.yM) * share;
    pose.zM = a.zM + (b.zM - a.zM) * share;
    pose.headingRad = mixAngle(a.headingRad, b.headingRad, share);
    pose.pitchRad = mixAngle(a.pitchRad, b.pitchRad, share);
    pose.rollRad = mixAngle(a.rollRad, b.rollRad, share);
    pose.speedMps = a.speedMps + (b.speedMps - a.speedMps) * share;
    pose.throttle = b.throttle;
    pose.rudder = b.rudder;
  }
  return count;
}

/** Looks first at `likelyAt`: the order seldom changes between two frames. */
function bodyOf(state: BodiesState, boatId: number, likelyAt: number): BodyPose | undefined {
  const likely = state.bodies[likelyAt];
  if (likely?.boatId === boatId) return likely;
  for (const body of state.bodies) if (body.boatId === boatId) return body;
  return undefined;
}

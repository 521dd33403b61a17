import { describe, expect, it } from "vitest";

import { mixAngle, wrapAngle } from "../src/scene/maths/interpolate";
import type { BodyPose } from "../client/codec/bodies";
import { makePose, mixBodies, unpackBodies, type BodiesState } from "../src/scene/frames/bodies";
import type { BodiesFrame } from "../src/net/messages";
import { bodiesPayload, type BodyRecord } from "./wire";

function frame(timeS: number, records: Partial<BodyRecord>[], spareBytes = 0): BodiesFrame {
  const payload = bodiesPayload(records);
  const buffer = new ArrayBuffer(payload.length + spareBytes);
  new Uint8Array(buffer).set(payload);
  return { layer: "bodies", tick: 1n, stateId: 0n, timeS, serverTimeS: timeS, level: "full", count: records.length, buffer };
}

function state(timeS: number, ...bodies: Partial<BodyPose>[]): BodiesState {
  return { timeS, stateId: 0n, bodies: bodies.map((body) => ({ ...makePose(), ...body })) };
}

describe("a bodies frame", () => {
  it("unpacks every field with its unit and sign", () => {
    const record = { boatId: 4_000_000_000, xMm: -1234, yMm: 56, zMm: 7_000_000, heading: 32767, pitch: -16384, roll: 8192, speedCmps: -250, throttle: -127, rudder: 64 };
    const { timeS, bodies } = unpackBodies(frame(2.5, [{ boatId: 1 }, record], 100));
    expect(timeS).toBe(2.5);
    expect(bodies).toHaveLength(2);
    expect(bodies[1]).toMatchObject({ boatId: 4_000_000_000, xM: -1.234, yM: 0.056, zM: 7000, speedMps: -2.5, throttle: -1 });
    expect(bodies[1]!.headingRad).toBeCloseTo(Math.PI, 9);
    expect(bodies[1]!.pitchRad).toBeCloseTo(-Math.PI / 2, 3);
    expect(bodies[1]!.rollRad).toBeCloseTo(Math.PI / 4, 3);
    expect(bodies[1]!.rudder).toBeCloseTo(64 / 127, 9);
  });

  it("may be empty, in a larger buffer", () => {
    expect(unpackBodies(frame(1, [], 512)).bodies).toEqual([]);
  });
});

describe("boats between two frames", () => {
  it("move on a straight line and turn the shorter way, also across ±180°", () => {
    const poses: BodyPose[] = [];
    const from = state(1, { boatId: 7, xM: 0, yM: 1, zM: -2, headingRad: 3.0, rollRad: 0.2, speedMps: 2 });
    const to = state(1.1, { boatId: 7, xM: 1, yM: 2, zM: -4, headingRad: -3.0, rollRad: -0.2, speedMps: 4 });
    expect(mixBodies(from, to, 0.25, poses)).toBe(1);
    expect(poses[0]).toMatchObject({ boatId: 7, xM: 0.25, yM: 1.25, zM: -2.5, speedMps: 2.5 });
    expect(poses[0]!.headingRad).toBeCloseTo(3.0 + 0.25 * (2 * Math.PI - 6), 9);
    expect(poses[0]!.rollRad).toBeCloseTo(0.1, 9);
  });

  it("are matched by id in any order", () => {
    const poses: BodyPose[] = [];
    const from = state(1, { boatId: 1, xM: 0 }, { boatId: 2, xM: 1 }, { boatId: 3, xM: 2 });
    const to = state(1.1, { boatId: 3, xM: 3 }, { boatId: 9, xM: 9 }, { boatId: 1, xM: 1 });
    expect(mixBodies(from, to, 0.5, poses)).toBe(3);
    expect(poses.map(({ boatId, xM }) => [boatId, xM])).toEqual([[1, 0.5], [2, 1], [3, 2.5]]);
  });

  it("reuse the pose objects when the number of boats changes", () => {
    const poses: BodyPose[] = [];
    const three = state(1, { boatId: 1 }, { boatId: 2 }, { boatId: 3 });
    mixBodies(three, three, 0, poses);
    const kept = [...poses];
    expect(mixBodies(state(2), state(2), 0, poses)).toBe(0);
    expect(mixBodies(three, three, 0, poses)).toBe(3);
    expect(poses.every((pose, at) => pose === kept[at])).toBe(true);
  });

  it("jump, not glide, from one periodic side to the other", () => {
    const poses: BodyPose[] = [];
    mixBodies(state(1, { boatId: 1, xM: 23.9, speedMps: 3 }), state(1.03, { boatId: 1, xM: -23.9, speedMps: 3 }), 0.5, poses);
    expect(poses[0]!.xM).toBe(23.9);
  });

  it("keep angles between -pi and pi", () => {
    for (let from = -3; from <= 3; from += 0.5)
      for (let to = -3; to <= 3; to += 0.5) {
        const mixed = mixAngle(from, to, 0.5);
        expect(Math.abs(mixed)).toBeLessThanOrEqual(Math.PI + 1e-9);
        expect(Math.abs(wrapAngle(mixed - from))).toBeLessThanOrEqual(Math.PI / 2 + 1e-9);
      }
  });
});

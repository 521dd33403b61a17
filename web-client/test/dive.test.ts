// Where the camera may be: in deep water of the square, not in the ground, in walls or in rocks; elsewhere above the water.
import { Vector3 } from "three";
import { describe, expect, it } from "vitest";

import type { GreetingInfo } from "../client/codec/greeting";
import type { SideKind } from "../client/codec/scene_info";
import { clearanceM } from "../src/scene/landscape/clearance";
import { diveView, diveWater, keepClear } from "../src/scene/camera/dive";

const kNearM = 0.1;
const kSides: Record<"-x" | "+x" | "-z" | "+z", SideKind> = { "-x": "open", "+x": "closed", "-z": "open", "+z": "open" };
const kRock = { shape: "rock", xM: 3, zM: 0, radiusM: 1.5, heightM: 1 } as const;
const kWall = { shape: "breakwater", xM: -4, zM: -2, lengthM: 6, widthM: 1, headingRad: 0.7, heightM: 0.8 } as const;

function water(change: Partial<GreetingInfo> = {}, depthM = 2) {
  const wave = { resolutionCount: 32, sideM: 16, depthM, periodicX: false, periodicZ: false, sides: kSides, spongeWidthM: 2, dampingPerS: 0, isNonlinear: false };
  const greeting = { sideM: 16, widthM: 16, setting: "openSea", waterExtents: { sideM: 16, longM: 16, depthM }, obstacles: [kRock, kWall], beaches: [{ side: "+x", widthM: 6, shoreDepthM: 0 }], wave, ...change };
  return diveWater(greeting as unknown as GreetingInfo, kNearM);
}

const kept = (x: number, y: number, z: number, change: Partial<GreetingInfo> = {}): Vector3 => {
  const at = new Vector3(x, y, z);
  keepClear(water(change)!, at);
  return at;
};

describe("a camera", () => {
  it("stays where it is in the air and in deep water", () => {
    for (const at of [new Vector3(0, 5, 0), new Vector3(40, 3, 40), new Vector3(-1, -1, 4), new Vector3(0, 0, 0)]) {
      const before = at.clone();
      expect(keepClear(water()!, at)).toBe(false);
      expect(at).toEqual(before);
    }
  });

  it("stays above the bed, and above the water where it is shallow or outside the square", () => {
    expect(kept(-1, -7, 4).y).toBeCloseTo(-2 + 1.6 * kNearM, 6);
    expect(kept(7.6, -0.5, 0).y).toBeGreaterThan(0);
    expect(kept(20, -1, -20).y).toBeGreaterThan(0);
    expect(kept(-20, -1, 0).y).toBeGreaterThan(0);
  });

  it("stays out of rocks and walls, and flies over them", () => {
    for (const [x, z] of [[3, 0], [3.4, 0.2], [2, -0.9]] as const) {
      const at = kept(x, -0.5, z);
      expect(clearanceM(kRock, at.x, at.z)).toBeGreaterThanOrEqual(1.6 * kNearM - 1e-6);
    }
    const beside = kept(-4.2, -0.4, -1.9);
    expect(clearanceM(kWall, beside.x, beside.z)).toBeGreaterThan(0);
    expect(kept(3, 4, 0)).toEqual(new Vector3(3, 4, 0));
  });

  it("looks at a tank from outside and stays inside", () => {
    const tank: Partial<GreetingInfo> = { setting: "glassTank", obstacles: [], beaches: [] };
    expect(kept(0, -0.8, 20, tank).y).toBeCloseTo(-0.8, 9);
    expect(kept(0, -5, 20, tank).y).toBeCloseTo(-1, 9);
    expect(kept(7.99, -1, 0, tank).x).toBeCloseTo(8 - 1.6 * kNearM, 9);
  });

  it("does not dive in shallow water or without a wave", () => {
    expect(water({}, 3 * kNearM)).toBeUndefined();
    expect(water({ wave: undefined } as Partial<GreetingInfo>)).toBeUndefined();
  });
});

describe("the view from below", () => {
  it("is in the water with room around, looking up", () => {
    const ahead = new Vector3(-0.4, 0.3, -0.8).normalize();
    for (const depthM of [0.6, 2, 12]) {
      const room = water({}, depthM)!;
      const { positionM, targetM } = diveView(room, ahead);
      expect(positionM.y).toBeLessThan(0);
      expect(positionM.y).toBeGreaterThan(room.groundM(positionM.x, positionM.z));
      expect(keepClear(room, positionM)).toBe(false);
      for (const obstacle of room.obstacles) expect(clearanceM(obstacle, positionM.x, positionM.z)).toBeGreaterThan(kNearM);
      expect(targetM.clone().sub(positionM).normalize().distanceTo(ahead)).toBeLessThan(1e-9);
    }
  });
});

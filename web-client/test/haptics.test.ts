// What is felt, and where: on the phone, in the gamepad, or not at all.
import { afterEach, describe, expect, it, vi } from "vitest";

import { Haptics, kGamepadId } from "../src/app/haptics";
import type { GreetingInfo } from "../client/codec/greeting";
import { makePose } from "../src/scene/frames/bodies";

function device(has: { phone?: boolean; motors?: boolean }) {
  const felt: string[] = [];
  const pad = { mapping: "standard", vibrationActuator: has.motors ? { playEffect: () => (felt.push("gamepad"), Promise.reject(new Error("no motors after all"))) } : null };
  vi.stubGlobal("navigator", { ...(has.phone && { vibrate: () => felt.push("phone") }), getGamepads: () => [null, pad] });
  return felt;
}

afterEach(() => vi.unstubAllGlobals());

describe("what one does oneself", () => {
  it("is felt where it was done: a finger on the phone, a gamepad in its motors, a mouse nowhere", () => {
    const felt = device({ phone: true, motors: true });
    const haptics = new Haptics();
    haptics.feel("splash", { pointerId: 1, pointerType: "mouse" });
    expect(felt).toEqual([]);
    haptics.feel("splash", { pointerId: 1, pointerType: "touch" });
    expect(felt).toEqual(["phone"]);
    haptics.feel("catch", { pointerId: kGamepadId, pointerType: "mouse" });
    expect(felt).toEqual(["phone", "gamepad"]);
  });

  it("is not felt while that is off, and where there is nothing to feel it with", () => {
    const felt = device({ phone: true, motors: true });
    const haptics = new Haptics();
    haptics.wanted = false;
    haptics.feel("knock");
    expect(felt).toEqual([]);
    device({});
    haptics.wanted = true;
    expect(() => haptics.feel("knock")).not.toThrow();
  });
});

describe("one's own boat", () => {
  it("is felt when it knocks against something; those of others are not", () => {
    const felt = device({ phone: true });
    const haptics = new Haptics();
    const greeting = { boats: [1, 2].map((boatId) => ({ boatId, lengthM: 4, beamM: 1.5, heightM: 1, draughtM: 0.4 })), gravityMps2: 9.81 } as unknown as GreetingInfo;
    const sail = (timeS: number, speedsMps: readonly [number, number]) => {
      const state = { timeS, stateId: 0n, bodies: speedsMps.map((speedMps, k) => ({ ...makePose(), boatId: k + 1, speedMps })) };
      haptics.follow({ frames: { bodies: { newest: () => state } }, heightAtM: () => 0 } as never, greeting, 1);
    };
    sail(0, [3, 3]);
    sail(0.033, [3, 0]);
    expect(felt).toEqual([]);
    sail(0.066, [0, 0]);
    expect(felt).toEqual(["phone"]);
  });
});

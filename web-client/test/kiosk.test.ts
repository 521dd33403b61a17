// A kiosk's decisions: phases of a visit, what visitors may send, when the page reloads, where the camera is.
import { describe, expect, it } from "vitest";

import { attractEye } from "../src/kiosk/attract_camera";
import { kioskOptions } from "../src/kiosk/options";
import { Visit } from "../src/kiosk/visit";
import { VisitorLimits } from "../src/kiosk/visitor_limits";
import { Watchdog } from "../src/kiosk/watchdog";
import type { CommandAction } from "../client/session/events";

describe("the address of a kiosk", () => {
  it("has the seconds until the countdown", () => {
    expect(kioskOptions("?kiosk")).toEqual({ idleS: 60, problem: undefined });
    expect(kioskOptions("?room=a&kiosk=90")).toEqual({ idleS: 90, problem: undefined });
  });

  it("with other values says the bounds and uses the default", () => {
    for (const text of ["9", "3601", "soon", "-20", "1e3", "NaN"]) {
      const { idleS, problem } = kioskOptions(`?kiosk=${text}`);
      expect(idleS).toBe(60);
      expect(problem).toBe(`kiosk=${text} in the address: expected seconds from 10 to 3600; 60 are used`);
    }
  });
});

describe("a visit", () => {
  it("begins with a touch, counts down without input, and ends", () => {
    const visit = new Visit(60);
    visit.update(0);
    expect(visit.phase).toBe("attract");
    visit.touched(1000);
    visit.update(60_999);
    expect(visit.phase).toBe("active");
    visit.update(61_000);
    expect([visit.phase, visit.secondsLeft(61_000), visit.secondsLeft(64_500)]).toEqual(["countdown", 10, 7]);
    visit.update(70_999);
    expect(visit.phase).toBe("countdown");
    visit.update(71_000);
    expect(visit.phase).toBe("attract");
  });

  it("continues when somebody touches during the countdown", () => {
    const visit = new Visit(60);
    visit.touched(0);
    visit.update(65_000);
    visit.touched(66_000);
    visit.update(125_999);
    expect(visit.phase).toBe("active");
  });
});

describe("the limits of visitors", () => {
  const splash: CommandAction = { case: "splash", value: {} };

  it("refuse whatever is not in the water", () => {
    const limits = new VisitorLimits();
    const others: CommandAction[] = [
      { case: "setPaused", value: { paused: true } }, { case: "reset", value: {} }, { case: "changeScene", value: {} }, { case: "setParameter", value: {} },
      { case: "setSpeed", value: {} }, { case: "takeBoat", value: { boatId: 1 } }, { case: "removeFloater", value: { all: true } }, { case: "removeFloater", value: { floaterId: 7 } }, { case: "removeBoat", value: { boatId: 3 } },
      { case: "placeGauge", value: {} }, { case: "removeGauge", value: { gaugeId: 1 } },
    ];
    for (const action of others) expect([action.case, limits.takes(action, [1], 0)]).toEqual([action.case, false]);
    expect(limits.refusedCount).toBe(others.length);
    expect(limits.takes({ case: "removeBoat", value: { boatId: 1 } }, [1], 0)).toBe(true);
  });

  it("allow a burst of splashes and then two per second, and always the end of a stroke", () => {
    const limits = new VisitorLimits();
    const taken = (fromMs: number, count: number, everyMs: number) => Array.from({ length: count }, (_, k) => limits.takes(splash, [], fromMs + k * everyMs)).filter(Boolean).length;
    expect(taken(0, 50, 0)).toBe(6);
    expect(taken(0, 100, 100)).toBeGreaterThanOrEqual(19);
    expect(taken(10_000, 1000, 1)).toBeLessThanOrEqual(4);
    for (let k = 0; k < 500; ++k) expect(limits.takes({ case: "stroke", value: {} }, [], 0)).toBe(true);
  });

  it("allow one boat, and take out the oldest object when there are too many", () => {
    const limits = new VisitorLimits();
    expect(limits.takes({ case: "spawnBoat", value: {} }, [4], 0)).toBe(false);
    expect(limits.takes({ case: "spawnBoat", value: {} }, [], 0)).toBe(true);
    for (let id = 1; id <= 12; ++id) expect(limits.added(id)).toEqual([]);
    expect(limits.added(13)).toEqual([1]);
    expect(limits.takes({ case: "removeFloater", value: { floaterId: 1 } }, [], 0)).toBe(true);
    limits.removed(1);
    expect(limits.floaterIds).toHaveLength(12);
  });
});

describe("the watchdog", () => {
  /** Returns after how many seconds it reloads; undefined within an hour. */
  function reloadsAfterS(watchdog: Watchdog, has: { pictures: boolean; isConnected: boolean; isVisible?: boolean }): number | undefined {
    for (let s = 0; s <= 3600; ++s) {
      if (has.pictures) watchdog.pictureDrawn();
      if (watchdog.update(1000 * s, { isVisible: has.isVisible ?? true, isConnected: has.isConnected }) !== undefined) return s;
    }
    return undefined;
  }

  it("reloads without pictures, or without a connection, and waits longer each time up to a bound", () => {
    expect([0, 1, 2, 3, 10].map((count) => reloadsAfterS(new Watchdog(count), { pictures: false, isConnected: true }))).toEqual([30, 60, 120, 240, 600]);
    expect([0, 1, 10].map((count) => reloadsAfterS(new Watchdog(count), { pictures: true, isConnected: false }))).toEqual([120, 240, 600]);
  });

  it("leaves a page alone that works, and one that is hidden", () => {
    expect(reloadsAfterS(new Watchdog(0), { pictures: true, isConnected: true })).toBeUndefined();
    expect(reloadsAfterS(new Watchdog(0), { pictures: false, isConnected: true, isVisible: false })).toBeUndefined();
  });

  it("forgets reloads after a while without trouble, and does not count the sleep of a page", () => {
    const watchdog = new Watchdog(4);
    for (let s = 0; s <= 601; ++s) {
      watchdog.pictureDrawn();
      watchdog.update(1000 * s, { isVisible: true, isConnected: true });
    }
    expect(watchdog.reloads).toBe(0);
    expect(watchdog.update(1e7, { isVisible: true, isConnected: true })).toBeUndefined();
  });
});

describe("the camera of a kiosk", () => {
  it("begins in the first view, moves slowly, and keeps its distance and the level", () => {
    const [eye, target] = [[0, 6, 12] as [number, number, number], [1, 0, 2] as [number, number, number]];
    const radius = ([x, y, z]: number[]) => Math.hypot(x! - target[0], y! - target[1], z! - target[2]);
    expect(attractEye(eye, target, 0)).toEqual(eye);
    let before = eye;
    let most = 0;
    for (let s = 0.1; s < 200; s += 0.1) {
      const now = attractEye(eye, target, s);
      const stepM = Math.hypot(...now.map((each, axis) => each - before[axis]!));
      expect(stepM).toBeLessThan(0.1);
      expect(radius(now) / radius(eye)).toBeGreaterThan(0.87);
      expect(radius(now) / radius(eye)).toBeLessThan(1.001);
      most = Math.max(most, Math.hypot(...now.map((each, axis) => each - eye[axis]!)));
      before = now;
    }
    expect(most).toBeGreaterThan(3);
  });
});

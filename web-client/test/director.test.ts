import { describe, expect, it } from "vitest";

import { beginDirecting, direct, wideFraming, type DirectorState, type Sight } from "../src/class/director";
import { standingOut } from "../src/class/splash_sense";
import { spokenAddress, withRoom } from "../src/class/join_card";
import type { GameInfo } from "../client/codec/game";
import { floatPlaces } from "../src/scene/boats/course_marks";

const calm: Sight = { nowS: 0, sideM: 64, widthM: 48, boats: [], racerBoatIds: [], fingers: [], movedFloaters: [], splash: undefined, game: undefined, ball: undefined, marks: [], goals: [] };
const game = (change: Partial<GameInfo>): GameInfo => ({ kind: "race", phase: "running", beginsS: 0, endsS: 0, lapsCount: 2, goalsCount: 3, racers: [], redGoalsCount: 0, blueGoalsCount: 0, winnerPersonId: 0, winnerTeam: undefined, ballFloaterId: 0, ...change });
const boat = (boatId: number, xM: number, zM: number, speedMps = 0) => ({ boatId, xM, zM, speedMps });
const racer = (personId: number, finishedS = 0) => ({ personId, lapsCount: 0, nextMark: 0, lapBestS: 0, finishedS });

/** Directs for a while at 30 pictures per second. */
function after(state: DirectorState, seconds: number, sightAt: (nowS: number) => Sight): DirectorState {
  const beganS = state.atS;
  for (let n = 1; n <= 30 * seconds; ++n) state = direct(state, { ...sightAt(beganS + n / 30), nowS: beganS + n / 30 });
  return state;
}

describe("the projector's camera", () => {
  it("shows the whole water while it is calm", () => {
    const state = after(beginDirecting(calm), 60, () => calm);
    expect(state).toMatchObject({ shot: "wide", now: wideFraming(calm) });
  });

  it("goes to where most is going on, and back to everybody", () => {
    const busy: Sight = { ...calm, fingers: [{ xM: 20, zM: 10 }, { xM: 22, zM: 11 }, { xM: -25, zM: 0 }] };
    const near = after(beginDirecting(calm), 20, () => busy);
    expect(near.shot).toBe("action");
    expect(Math.hypot(near.now.xM - 21, near.now.zM - 10.5)).toBeLessThan(1.5);
    expect(near.now.radiusM).toBeLessThan(0.4 * wideFraming(calm).radiusM);
    const shots = new Set<string>();
    let state = near;
    for (let n = 0; n < 40; ++n) shots.add((state = after(state, 1, () => busy)).shot);
    expect(shots).toEqual(new Set(["action", "wide"]));
  });

  it("cuts at most once in eight seconds, however the activity jumps", () => {
    let state = beginDirecting(calm);
    let cuts = 0;
    let before = state.shot;
    for (let n = 0; n < 120; ++n) {
      state = after(state, 1, (nowS) => (Math.floor(nowS * 3) % 2 === 0 ? { ...calm, fingers: [{ xM: 20, zM: 10 }] } : calm));
      if (state.shot !== before) ++cuts;
      before = state.shot;
    }
    expect(cuts).toBeGreaterThan(1);
    expect(cuts).toBeLessThanOrEqual(120 / 8);
  });

  it("moves smoothly: never faster than a part of the water per picture", () => {
    let state = beginDirecting(calm);
    let before = state.now;
    for (let n = 0; n < 900; ++n) {
      const at = n % 300 < 150 ? { xM: 25, zM: 15 } : { xM: -25, zM: -15 };
      state = direct(state, { ...calm, nowS: (n + 1) / 30, fingers: [at, at] });
      expect(Math.hypot(state.now.xM - before.xM, state.now.zM - before.zM)).toBeLessThan(0.06 * 64);
      expect(Math.abs(state.now.radiusM - before.radiusM)).toBeLessThan(0.05 * 64);
      before = state.now;
    }
  });

  it("follows the leaders of a race, who are left when others have finished", () => {
    const boats = [boat(1, 20, 10, 3), boat(2, 18, 9, 3), boat(3, -20, -15, 3), boat(4, -22, -15, 3), boat(5, -21, -14, 3)];
    const racing: Sight = { ...calm, boats, racerBoatIds: [1, 2], game: game({ racers: [racer(1), racer(2)] }), marks: [{ xM: 22, zM: 12 }] };
    const state = after(beginDirecting(calm), 12, () => racing);
    expect(state.shot).toBe("leaders");
    expect(state.now.xM).toBeGreaterThan(15);
    const late: Sight = { ...racing, racerBoatIds: [1, 2, 3], game: game({ racers: [racer(1, 30), racer(2, 31), racer(3)] }) };
    expect(after(state, 15, () => late).now.xM).toBeLessThan(-10);
  });

  it("shows the start before a race, and the winner after it at once", () => {
    const boats = [boat(1, -6, 13), boat(2, -6, 15)];
    const start: Sight = { ...calm, boats, racerBoatIds: [1, 2], game: game({ phase: "countdown", racers: [racer(1), racer(2)] }), marks: [{ xM: 20, zM: 13 }] };
    const begun = after(beginDirecting(calm), 2, () => start);
    expect(begun.shot).toBe("start");
    const over: Sight = { ...start, game: game({ phase: "over", racers: [racer(2, 40), racer(1, 42)] }), racerBoatIds: [2, 1] };
    expect(after(begun, 1, () => over).shot).toBe("winner");
  });

  it("shows both goals with the ball and the boats near it, and stays wide without a ball", () => {
    const goals = [{ xM: -25, zM: 4 }, { xM: 27, zM: 4 }];
    const far: Sight = { ...calm, game: game({ kind: "ball" }), ball: { xM: 10, zM: -5 }, goals };
    const { now } = after(beginDirecting(calm), 12, () => far);
    for (const place of [...goals, far.ball!]) expect(Math.hypot(place.xM - now.xM, place.zM - now.zM)).toBeLessThan(now.radiusM);
    const ball: Sight = { ...far, goals: [], boats: [boat(1, 13, -5, 1), boat(2, -30, 0, 1)] };
    const state = after(beginDirecting(calm), 12, () => ball);
    expect(state.shot).toBe("ball");
    expect(Math.abs(state.now.xM - 11.5)).toBeLessThan(1);
    expect(after(beginDirecting(calm), 5, () => ({ ...ball, ball: undefined, boats: [] })).shot).toBe("wide");
  });

  it("survives a page that was hidden: a long time is one gentle step", () => {
    const state = direct(beginDirecting(calm), { ...calm, nowS: 3600, fingers: [{ xM: 20, zM: 10 }] });
    expect(Number.isFinite(state.now.radiusM)).toBe(true);
    expect(Math.abs(state.now.xM)).toBeLessThan(20);
  });
});

describe("waves that stand out", () => {
  const frame = (values: Int16Array) => ({ layer: "surface" as const, tick: 1n, stateId: 1n, timeS: 0, serverTimeS: 0, level: "full" as const, resolutionCount: 40, countZ: 40, sideM: 20, widthM: 20, quantumM: 0.001, buffer: values.buffer as ArrayBuffer });

  it("are found in calm water, and not among many of the same height", () => {
    const still = new Int16Array(1600);
    expect(standingOut(frame(still))).toBeUndefined();
    still[40 * 30 + 10] = 400;
    expect(standingOut(frame(still))).toEqual({ xM: -4.75, zM: expect.closeTo(5.25, 9) });
    expect(standingOut(frame(still.map((_, n) => (n % 3 === 0 ? 300 : -200))))).toBeUndefined();
    expect(standingOut(frame(new Int16Array(1600).fill(0).map((_, n) => (n === 5 ? 3 : 0))))).toBeUndefined();
  });
});

describe("the address of the pads", () => {
  it("leads to the room that the projector shows, and is short to type", () => {
    expect(withRoom("http://192.168.1.20:8080/pad", "?class")).toBe("http://192.168.1.20:8080/pad");
    expect(withRoom("http://192.168.1.20:8080/pad", "?class&room=a b")).toBe("http://192.168.1.20:8080/pad?room=a+b");
    expect(spokenAddress("http://192.168.1.20:8080/pad")).toBe("192.168.1.20:8080/pad");
    expect(spokenAddress("https://water.example.org/pad/")).toBe("https://water.example.org/pad");
  });
});

describe("a goal's floats", () => {
  it("lie on its frame, each corner once", () => {
    const places = floatPlaces({ xM: 10, zM: -2, lengthM: 3, widthM: 12 });
    for (const { xM, zM } of places) expect(Math.max(Math.abs(xM - 10) / 1.5, Math.abs(zM + 2) / 6)).toBeCloseTo(1, 9);
    expect(new Set(places.map(({ xM, zM }) => `${xM.toFixed(6)} ${zM.toFixed(6)}`)).size).toBe(places.length);
    expect(places.length).toBeLessThanOrEqual(36);
  });
});

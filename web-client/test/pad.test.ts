import { describe, expect, it } from "vitest";

import type { GameInfo } from "../client/codec/game";
import type { GreetingInfo } from "../client/codec/greeting";
import type { CommandAction } from "../client/session/events";
import { isPadAddress } from "../src/app/address";
import { friendlyName } from "../src/pad/friendly_name";
import { gameTouch } from "../src/pad/game_touch";
import { boatView, edgeOf, ontoWater, toPlace, toPx, turnFor, wholeView } from "../src/pad/map_view";
import { PadHands, type PadWater } from "../src/pad/pad_hands";
import { compassText } from "../src/pad/pad_words";
import { stickSetting } from "../src/pad/stick";
import { WaterShade } from "../src/pad/water_shade";
import { FakeTime } from "./fakes";

const kWater = { sideM: 64, widthM: 48 };

describe("the pad's map", () => {
  it("shows the whole water, +x to the right and +z down, and finds each place again", () => {
    for (const size of [{ widthPx: 390, heightPx: 700 }, { widthPx: 760, heightPx: 330 }]) {
      const view = wholeView(kWater, size);
      for (const [xM, zM] of [[-32, -24], [32, 24], [0, 0], [5, -7]] as const) {
        const [x, y] = toPx(view, { xM, zM });
        expect(x >= 9.9 && x <= size.widthPx - 9.9 && y >= 9.9 && y <= size.heightPx - 9.9).toBe(true);
        const back = toPlace(view, x, y);
        expect([back.xM, back.zM].map((value) => Math.abs(value))).toEqual([expect.closeTo(Math.abs(xM), 9), expect.closeTo(Math.abs(zM), 9)]);
      }
      expect(toPx(view, { xM: 1, zM: 0 })[0]).toBeGreaterThan(toPx(view, { xM: 0, zM: 0 })[0]);
      expect(toPx(view, { xM: 0, zM: 1 })[1]).toBeGreaterThan(toPx(view, { xM: 0, zM: 0 })[1]);
    }
  });

  it("points to what it does not show, from the boat through the edge", () => {
    const size = { widthPx: 390, heightPx: 700 };
    const view = boatView({ xM: 0, zM: 0, lengthM: 2 }, turnFor(-Math.PI / 2), 64, size);
    expect(edgeOf(view, toPx(view, { xM: 1, zM: -2 }), size)).toBeUndefined();
    const right = edgeOf(view, toPx(view, { xM: 60, zM: 0 }), size)!;
    expect([right.xPx, right.yPx, right.angleRad]).toEqual([expect.closeTo(364, 6), expect.closeTo(420, 6), expect.closeTo(0, 6)]);
    const ahead = edgeOf(view, toPx(view, { xM: 0, zM: -60 }), size)!;
    expect([ahead.xPx, ahead.yPx, ahead.angleRad]).toEqual([expect.closeTo(195, 6), expect.closeTo(62, 6), expect.closeTo(-Math.PI / 2, 6)]);
    const behind = edgeOf(view, toPx(view, { xM: 0, zM: 60 }), size)!;
    expect(behind.yPx).toBeCloseTo(504, 6);
  });

  it("turns so that one's boat looks up", () => {
    for (const headingRad of [0, 1, -2.5, Math.PI]) {
      const boat = { xM: 3, zM: -4, lengthM: 2 };
      const view = boatView(boat, turnFor(headingRad), 48, { widthPx: 390, heightPx: 600 });
      const [x, y] = toPx(view, boat);
      const ahead = toPx(view, { xM: 3 + Math.cos(headingRad), zM: -4 + Math.sin(headingRad) });
      expect([x, y]).toEqual([195, 360]);
      expect(ahead[0]).toBeCloseTo(195, 6);
      expect(ahead[1]).toBeLessThan(360);
      const back = toPlace(view, ...ahead);
      expect(back.xM).toBeCloseTo(3 + Math.cos(headingRad), 6);
      expect(back.zM).toBeCloseTo(-4 + Math.sin(headingRad), 6);
    }
  });

  it("keeps fingers beside the water on it", () => {
    const { xM, zM } = ontoWater({ xM: 900, zM: -900 }, kWater);
    expect(xM).toBeLessThan(32);
    expect(zM).toBeGreaterThan(-24);
  });

  it("shades slopes that face the light, and land not at all", () => {
    const count = 16;
    const heights = Int16Array.from({ length: count * count }, (_, n) => (n % count) * 20);
    const pixels = new Uint8ClampedArray(4 * count * count);
    const isLand = new Uint8Array(count * count);
    isLand[5] = 1;
    const surface = { resolutionCount: count, countZ: count, sideM: 8, widthM: 8, mix: 0, fromQuantumM: 0.001, toQuantumM: 0.001 };
    const shadeOf = (samples: Int16Array, at: number): number => {
      new WaterShade().shade({ ...surface, from: samples, to: samples }, isLand, pixels);
      return pixels[4 * at]! + pixels[4 * at + 1]! + pixels[4 * at + 2]!;
    };
    const [level, up, down] = [shadeOf(new Int16Array(count * count), 100), shadeOf(heights, 100), shadeOf(heights.map((height) => -height), 100)];
    expect(up).toBeGreaterThan(level);
    expect(down).toBeLessThan(level);
    expect(shadeOf(heights, 5)).toBe(shadeOf(new Int16Array(count * count), 5));
  });
});

describe("the pad's stick", () => {
  it("rests in the middle, is full at its end, and steers to the side it is pushed to", () => {
    expect(stickSetting(0.1, -0.1)).toEqual({ throttleRatio: 0, rudderRatio: 0 });
    expect(stickSetting(0, -1)).toEqual({ throttleRatio: 1, rudderRatio: 0 });
    expect(stickSetting(0, 1).throttleRatio).toBe(-1);
    expect(stickSetting(-2, 0)).toEqual({ throttleRatio: 0, rudderRatio: -1 });
    expect(stickSetting(0.57, -0.57).throttleRatio).toBeCloseTo(0.5, 1);
  });
});

describe("fingers on the pad", () => {
  const greeting = { ...kWater, waterExtents: { sideM: 48, longM: 64, depthM: 2.5 }, gravityMps2: 9.81 } as GreetingInfo;
  const water: PadWater = { greeting, placeOf: (xPx, yPx) => ({ xM: (xPx - 320) / 10, zM: (yPx - 240) / 10 }), pxPerM: 10, floaters: [], heightAtM: () => 0 };
  const rig = () => {
    const time = new FakeTime();
    const sent: CommandAction[] = [];
    const hands = new PadHands((action) => sent.push(action), { nowMs: () => time.nowMs, setTimer: (callback, ms) => time.setTimer(callback, ms), clearTimer: (timer) => time.clearTimer(timer) }, () => 0.5);
    return { time, sent, hands };
  };

  it("draw a stroke each, and end it", () => {
    const { time, sent, hands } = rig();
    hands.press(1, 320, 240, "finger", water);
    hands.press(2, 400, 240, "finger", water);
    time.advance(50);
    hands.move(1, 330, 240, water);
    hands.release(1, water);
    hands.liftAll();
    expect(sent.every((action) => action.case === "stroke")).toBe(true);
    const strokes = sent.map(({ value }) => value as { strokeId: number; ends?: boolean });
    expect(new Set(strokes.map(({ strokeId }) => strokeId)).size).toBe(2);
    expect(strokes.filter(({ ends }) => ends).length).toBe(2);
    expect(hands.places()).toEqual([]);
  });

  it("send one splash, wave or stone when they are lifted", () => {
    for (const [mode, wanted] of [["splash", "splash"], ["wave", "breakingWave"], ["throw", "spawnFloater"]] as const) {
      const { time, sent, hands } = rig();
      hands.press(1, 200, 240, mode, water);
      time.advance(300);
      hands.move(1, 320, 240, water);
      expect(hands.previews(water.greeting).length).toBe(1);
      hands.release(1, water);
      expect(sent.map((action) => action.case)).toEqual([wanted]);
    }
  });

  it("take hold of an object that they touch, and drop one elsewhere", () => {
    const crate = { floaterId: 7, kind: "crate" as const, xM: 0, yM: 0, zM: 0, turn: [0, 0, 0, 1] as [number, number, number, number], sizeM: 1, isHeld: false };
    const { sent, hands } = rig();
    hands.press(1, 325, 240, "float", { ...water, floaters: [crate] });
    hands.release(1, { ...water, floaters: [crate] });
    expect(sent.map((action) => action.case)).toEqual(["holdFloater", "holdFloater"]);
    hands.press(2, 100, 100, "float", { ...water, floaters: [crate] });
    hands.release(2, { ...water, floaters: [crate] });
    expect(sent.at(-1)!.case).toBe("spawnFloater");
  });
});

describe("what the phone says to the hand", () => {
  it("tells start, marks, laps, the finish and goals apart", () => {
    const racer = { personId: 4, lapsCount: 0, nextMark: 1, lapBestS: 0, finishedS: 0 };
    const game: GameInfo = { kind: "race", phase: "running", beginsS: 0, endsS: 0, lapsCount: 2, goalsCount: 3, racers: [racer], redGoalsCount: 0, blueGoalsCount: 0, winnerPersonId: 0, winnerTeam: undefined, ballFloaterId: 0 };
    const now = (change: object): GameInfo => ({ ...game, racers: [{ ...racer, ...change }] });
    expect(gameTouch({ ...game, phase: "countdown" }, game, 4)).toBe("start");
    expect(gameTouch(game, now({ nextMark: 2 }), 4)).toBe("mark");
    expect(gameTouch(game, now({ nextMark: 0, lapsCount: 1 }), 4)).toBe("lap");
    expect(gameTouch(game, now({ lapsCount: 2, finishedS: 60 }), 4)).toBe("finish");
    expect(gameTouch(game, now({ nextMark: 2 }), 5)).toBeUndefined();
    expect(gameTouch({ ...game, kind: "ball" }, { ...game, kind: "ball", redGoalsCount: 1 }, 5)).toBe("goal");
    expect(gameTouch(undefined, game, 4)).toBeUndefined();
  });
});

describe("the pad's words", () => {
  it("give a compass heading", () => {
    expect([0, Math.PI / 2, -Math.PI / 2, Math.PI].map(compassText)).toEqual(["090°", "180°", "000°", "270°"]);
  });

  it("name people who have not said who they are", () => {
    for (const value of [0, 0.5, 0.999999]) expect(friendlyName(() => value)).toMatch(/^[A-Z][a-z]+ [A-Z][a-z]+$/);
  });

  it("are at the address /pad, also behind a proxy, and with ?pad", () => {
    const at = (address: string) => isPadAddress(new URL(address));
    expect(["http://a/pad", "http://a/water/pad?room=x", "http://a/?pad", "http://a/?room=x&pad"].map(at)).toEqual([true, true, true, true]);
    expect(["http://a/", "http://a/padded", "http://a/?room=pad"].map(at)).toEqual([false, false, false]);
  });
});

import { describe, expect, it } from "vitest";

import { PlayoutClock } from "../src/scene/frames/playout_clock";

describe("a held playout clock", () => {
  it("shows the held time, whatever arrives", () => {
    const clock = new PlayoutClock();
    clock.noteFrame(1, 1, 1);
    clock.hold(0.5);
    clock.noteFrame(2, 2, 2);
    expect(clock.displayTimeS(9)).toBe(0.5);
  });
});

interface Stream {
  frameRateHz: number;
  /** Transit time of a frame, by its number [s]. */
  transitS: (frame: number) => number;
  /** Simulated seconds per second. */
  speed?: number;
  /** The server's clock minus the client's. */
  leadS?: number;
  durationS?: number;
}

interface Picture {
  nowS: number;
  shownS: number;
  /** Simulation time of the newest frame that had arrived. */
  newestS: number;
  delayS: number;
}

/** The times that a display of 60 Hz shows of a stream, from the third second on. */
function watch({ frameRateHz, transitS, speed = 1, leadS = 1000, durationS = 8 }: Stream): Picture[] {
  const clock = new PlayoutClock();
  clock.sync(leadS);
  const frames: { timeS: number; stampS: number; arrivedS: number }[] = [];
  for (let k = 0; k < durationS * frameRateHz; ++k) {
    const sentS = k / frameRateHz;
    frames.push({ timeS: speed * sentS, stampS: sentS + leadS, arrivedS: sentS + transitS(k) });
  }
  // TCP delivers in order: a late frame delays the ones after it.
  frames.forEach((frame, k) => (frame.arrivedS = Math.max(frame.arrivedS, frames[k - 1]?.arrivedS ?? 0)));
  const pictures: Picture[] = [];
  let next = 0;
  for (let k = 0; k < 60 * durationS; ++k) {
    const nowS = k / 60;
    for (; next < frames.length && frames[next]!.arrivedS <= nowS; ++next) clock.noteFrame(frames[next]!.timeS, frames[next]!.stampS, frames[next]!.arrivedS);
    const shownS = clock.displayTimeS(nowS);
    if (shownS === undefined || nowS < 3) continue;
    pictures.push({ nowS, shownS, newestS: frames[next - 1]!.timeS, delayS: clock.delayS()! });
  }
  expect(pictures.length).toBeGreaterThan(100); // a clock that shows nothing would pass whatever is said of each picture
  return pictures;
}

/** The same numbers in every run, evenly in 0..1. */
function noise(k: number): number {
  const x = Math.sin(k * 12.9898) * 43758.5453;
  return x - Math.floor(x);
}

function steps(pictures: Picture[]): number[] {
  return pictures.slice(1).map((picture, k) => picture.shownS - pictures[k]!.shownS);
}

describe("the playout clock", () => {
  it("shows 20 uneven frames per second as even motion at 60 pictures per second", () => {
    const pictures = watch({ frameRateHz: 20, transitS: (k) => 0.03 + 0.025 * noise(k) });
    for (const step of steps(pictures)) {
      expect(step).toBeGreaterThan(0.88 / 60);
      expect(step).toBeLessThan(1.12 / 60);
    }
    // Nearly always there is a frame to interpolate to.
    expect(pictures.filter(({ shownS, newestS }) => shownS >= newestS).length).toBeLessThan(0.01 * pictures.length);
  });

  it("stays two frame intervals behind frames that arrive evenly", () => {
    for (const { delayS, nowS, shownS } of watch({ frameRateHz: 30, transitS: () => 0.04 })) {
      expect(delayS).toBeCloseTo(0.04 + 2 / 30, 6);
      expect(nowS - shownS).toBeCloseTo(delayS, 2);
    }
  });

  it("stays further behind while there is jitter", () => {
    // One frame in eight takes 0.2 s longer.
    const pictures = watch({ frameRateHz: 30, transitS: (k) => 0.02 + (k % 8 === 0 && k < 240 ? 0.2 : 0), durationS: 16 });
    const during = pictures.filter(({ nowS }) => nowS > 5 && nowS < 8);
    const after = pictures.filter(({ nowS }) => nowS > 13);
    for (const { delayS } of during) expect(delayS).toBeGreaterThan(0.15);
    expect(during.filter(({ shownS, newestS }) => shownS >= newestS).length).toBeLessThan(0.06 * during.length);
    for (const { delayS } of after) expect(delayS).toBeCloseTo(0.02 + 2 / 30, 6);
    for (const step of steps(pictures)) expect(step).toBeLessThan(1.12 / 60);
  });

  it("shows near and far clients the same time apart from their delay", () => {
    const near = watch({ frameRateHz: 30, transitS: (k) => 0.005 + 0.01 * noise(k), leadS: 5 });
    const far = watch({ frameRateHz: 30, transitS: (k) => 0.105 + 0.01 * noise(k), leadS: -7000 });
    near.forEach((picture, k) => expect(picture.shownS - far[k]!.shownS).toBeCloseTo(0.1, 2));
  });

  it("follows a simulation at half speed", () => {
    const pictures = watch({ frameRateHz: 30, transitS: () => 0.02, speed: 0.5 });
    for (const step of steps(pictures)) expect(step).toBeCloseTo(0.5 / 60, 4);
  });

  it("never runs back or ahead, and stops at the newest frame when the room is paused", () => {
    const pictures = watch({ frameRateHz: 30, transitS: (k) => 0.02 + (k >= 150 ? 1e6 : 0) + 0.1 * noise(k) });
    for (const step of steps(pictures)) expect(step).toBeGreaterThanOrEqual(0);
    for (const { shownS, newestS } of pictures) expect(shownS).toBeLessThanOrEqual(newestS + 1e-9);
    expect(pictures.at(-1)!.shownS).toBeCloseTo(149 / 30, 6);
  });

  it("restarts with the simulation", () => {
    const clock = new PlayoutClock();
    for (let frame = 0; frame < 30; ++frame) clock.noteFrame(100 + frame / 30, frame / 30, frame / 30);
    expect(clock.displayTimeS(1)).toBeGreaterThan(100);
    clock.noteFrame(0, 1.03, 1.03);
    expect(clock.displayTimeS(1.04)).toBeLessThanOrEqual(0);
  });

  it("has nothing to show before the first frame", () => {
    expect(new PlayoutClock().displayTimeS(5)).toBeUndefined();
    expect(new PlayoutClock().delayS()).toBeUndefined();
  });
});

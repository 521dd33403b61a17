import { describe, expect, it } from "vitest";

import type { App } from "../src/app/app";
import { nowS } from "../src/app/picture_clock";
import { SteppedPictures, wantsSteppedPictures } from "../src/app/stepped_pictures";
import type { FrameLayer } from "../client/codec/layers";
import type { Frame } from "../src/net/messages";

const kLayers: FrameLayer[] = ["surface", "bodies"];
const frame = (layer: FrameLayer, timeS: number): Frame => ({ layer, timeS }) as Frame;

function makeSteps() {
  const held: number[] = [];
  let drawnCount = 0;
  const display = {
    layers: kLayers,
    accepts: (_: Frame) => true,
    scene: { clock: { hold: (timeS: number) => held.push(timeS) } },
    draw: () => ++drawnCount,
  };
  const stepped = new SteppedPictures({ display } as unknown as App);
  return { stepped, display, held, drawnCount: () => drawnCount };
}

describe("pictures on request", () => {
  it("are asked for in the address", () => {
    expect(wantsSteppedPictures("?quality=low&pictures=stepped")).toBe(true);
    expect(wantsSteppedPictures("?quality=low")).toBe(false);
  });

  it("take one frame of each layer at the wanted time, and no other", async () => {
    const { stepped, display } = makeSteps();
    expect(display.accepts(frame("surface", 0))).toBe(false);
    let isDone = false;
    const taken = stepped.take(1.5).then(() => (isDone = true));
    expect(display.accepts(frame("surface", 1.5 - 1 / 60))).toBe(false);
    expect(display.accepts(frame("surface", 1.5 + 1e-9))).toBe(true);
    expect(display.accepts(frame("surface", 1.5))).toBe(false);
    await Promise.resolve();
    expect(isDone).toBe(false);
    expect(display.accepts(frame("bodies", 1.5))).toBe(true);
    await taken;
    expect(display.accepts(frame("bodies", 1.5))).toBe(false);
  });

  it("have a clock that moves with the water and on request only", () => {
    const { stepped } = makeSteps();
    expect(nowS()).toBe(0);
    void stepped.take(2);
    void stepped.take(2.5);
    expect(nowS()).toBeCloseTo(2.5);
    // The scene began again.
    void stepped.take(0);
    expect(nowS()).toBeCloseTo(2.5);
    stepped.pass(3);
    expect(nowS()).toBeCloseTo(5.5);
  });

  it("show the time that is asked for", () => {
    const { stepped, held, drawnCount } = makeSteps();
    stepped.draw(0.75);
    expect(held).toEqual([0.75]);
    expect(drawnCount()).toBe(1);
  });
});

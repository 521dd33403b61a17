import { PerspectiveCamera } from "three";
import { beforeEach, describe, expect, it, vi } from "vitest";

import type { App } from "../src/app/app";
import { FloaterHands, type PointerAt } from "../src/app/floater_hands";
import type { FloaterPose } from "../client/codec/floaters";
import { LessonState } from "../src/ui/lesson_state";
import { World } from "./fakes";

const kWidthPx = 800;
const kHeightPx = 600;

interface Sent {
  case: string;
  value: { floaterId: number; xM?: number; zM?: number; turnRadps?: number; ends?: boolean };
}

/** A page seen straight from above, 10 m over the water, without a browser. */
function makePage(floaters: FloaterPose[]) {
  const world = new World();
  const camera = new PerspectiveCamera(60, kWidthPx / kHeightPx, 0.1, 100);
  camera.position.set(0, 10, 0);
  camera.up.set(0, 0, -1);
  camera.lookAt(0, 0, 0);
  camera.updateMatrixWorld();
  const bin = { hidden: true, addEventListener: () => {}, getBoundingClientRect: () => ({ left: 350, right: 450, top: 550, bottom: 594 }) };
  vi.stubGlobal("document", { getElementById: () => bin });
  vi.stubGlobal("window", { setTimeout: world.setTimer, clearTimeout: world.clearTimer });
  vi.stubGlobal("WheelEvent", { DOM_DELTA_PIXEL: 0 });
  let wheel: (event: object) => void = () => {};
  const canvas = {
    clientHeight: kHeightPx,
    getBoundingClientRect: () => ({ left: 0, top: 0, width: kWidthPx, height: kHeightPx }),
    addEventListener: (_: string, listener: (event: object) => void) => (wheel = listener),
  };
  const sent: Sent[] = [];
  const felt: string[] = [];
  const app = {
    mayDraw: true,
    hasFloaters: true,
    lessons: new LessonState(),
    entered: { sideM: 8, widthM: 8 },
    answerListeners: [] as { ack(id: number): void; reject(id: number): void }[],
    commands: { send: (action: Sent) => sent.push(action) },
    display: { canvas, scene: { camera, drawnFloaters: () => floaters, heightAtM: () => 0 } },
    turnHeld: (_: number): boolean => false,
    haptics: { feel: (what: string, { pointerId }: { pointerId: number }) => felt.push(`${what} ${pointerId}`) },
  };
  const lost: number[] = [];
  const hands = new FloaterHands(app as unknown as App, (pointerId) => lost.push(pointerId));
  return { world, app, bin, sent, lost, felt, hands, wheel: (event: object) => wheel(event) };
}

const object = (change: Partial<FloaterPose>): FloaterPose => ({ floaterId: 1, kind: "ball", xM: 0, yM: 0, zM: 0, turn: [0, 0, 0, 1], sizeM: 1, isHeld: false, ...change });
/** Pixels per metre at the height of the still water. */
const kPxPerM = kHeightPx / (2 * 10 * Math.tan(Math.PI / 6));
const over = (xM: number, zM: number, pointerType = "mouse"): PointerAt => ({ clientX: kWidthPx / 2 + kPxPerM * xM, clientY: kHeightPx / 2 + kPxPerM * zM, pointerType });

describe("hands on objects", () => {
  beforeEach(() => {
    vi.unstubAllGlobals();
  });

  it("take hold with the finger and with the tool for objects, and with no other tool", () => {
    const { hands, app } = makePage([object({ floaterId: 4, xM: 1, zM: 2 })]);
    expect(hands.under(over(1, 2), "finger")).toMatchObject({ floaterId: 4, at: { xM: 1, zM: 2 } });
    expect(hands.under(over(1, 2), "float")?.floaterId).toBe(4);
    for (const tool of ["splash", "paddle", "rain", "calm", "throw"] as const) expect(hands.under(over(1, 2), tool)).toBeUndefined();
    expect(hands.under(over(-1, 2), "finger")).toBeUndefined();
    app.hasFloaters = false;
    expect(hands.under(over(1, 2), "finger")).toBeUndefined();
  });

  it("hit within 22 px of a finger, and leave sunken objects to the tool for objects", () => {
    const { hands } = makePage([object({ floaterId: 1, sizeM: 0.1 }), object({ floaterId: 2, xM: 2, yM: -2 })]);
    const aside = 21 / kPxPerM;
    expect(hands.under(over(aside, 0), "finger")).toBeUndefined();
    expect(hands.under(over(aside, 0, "touch"), "finger")?.floaterId).toBe(1);
    expect(hands.under(over((5 / 6) * 2, 0), "finger")).toBeUndefined();
    expect(hands.under(over((5 / 6) * 2, 0), "float")?.floaterId).toBe(2);
  });

  it("pull what they hold along with the pointer, from where it was touched and within the water", () => {
    const { hands, sent, world, bin } = makePage([object({ floaterId: 9, xM: 1, zM: 1 })]);
    let pointer = over(1.2, 1);
    hands.hold(3, hands.under(pointer, "finger")!, () => pointer);
    expect(bin.hidden).toBe(false);
    expect(sent[0]).toMatchObject({ case: "holdFloater", value: { floaterId: 9 } });
    expect(sent[0]!.value.xM).toBeCloseTo(1, 6);
    pointer = over(2.2, -1);
    world.pass(40);
    expect(sent.at(-1)!.value.xM).toBeCloseTo(2, 6);
    expect(sent.at(-1)!.value.zM).toBeCloseTo(-1, 6);
    pointer = over(6, -6);
    hands.end(3, pointer);
    expect(sent.at(-1)!.value).toMatchObject({ xM: 4, zM: -4, ends: true });
    expect(bin.hidden).toBe(true);
    expect(hands.isHolding(3)).toBe(false);
  });

  it("turn it by the wheel, which does not bring the camera nearer then, and by a second finger", () => {
    const { hands, sent, world, wheel, app } = makePage([object({})]);
    const event = { deltaY: 100, deltaX: 0, deltaMode: 0, preventDefault: vi.fn(), stopImmediatePropagation: vi.fn() };
    wheel(event);
    expect(event.preventDefault).not.toHaveBeenCalled();
    expect(app.turnHeld(1)).toBe(false);
    const turned = (): number => sent.splice(0).reduce((sum, { value }) => sum + 0.04 * (value.turnRadps ?? 0), 0);
    hands.hold(3, hands.under(over(0, 0), "finger")!, () => over(0, 0));
    wheel(event);
    expect(event.stopImmediatePropagation).toHaveBeenCalledOnce();
    world.pass(2000);
    expect(turned()).toBeCloseTo(0.4, 2);
    hands.beginTwist(3, over(0, 0), 4, over(1, 0));
    expect([hands.isTwisting(3), hands.isTwisting(4)]).toEqual([false, true]);
    // From +x toward +z, which is clockwise from above; across half a turn.
    for (let k = 1; k <= 8; ++k) hands.moved(4, over(Math.cos(0.5 * k), Math.sin(0.5 * k)));
    hands.moved(8, over(-1, 0));
    world.pass(4000);
    expect(turned()).toBeCloseTo(4, 2);
    hands.endTwist();
    hands.moved(4, over(1, 0));
    world.pass(1000);
    expect(turned()).toBe(0);
    hands.end(3);
  });

  it("take it out over the bin, and let go of what the server does not let them hold", () => {
    const { hands, sent, lost, felt, world, app } = makePage([object({ floaterId: 9 })]);
    const grip = hands.under(over(0, 0), "float")!;
    hands.hold(3, grip, () => over(0, 0));
    hands.end(3, { clientX: 400, clientY: 570, pointerType: "mouse" });
    expect(sent.at(-1)).toEqual({ case: "removeFloater", value: { floaterId: 9 } });
    expect(hands.removeHeld()).toBe(false);
    expect(felt).toEqual(["catch 3", "letGo 3"]);
    hands.hold(5, grip, () => over(0, 0));
    for (const listener of app.answerListeners) listener.reject(sent.length);
    expect(lost).toEqual([5]);
    const count = sent.length;
    world.pass(500);
    expect(sent).toHaveLength(count);
  });
});

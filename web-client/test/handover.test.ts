import { describe, expect, it } from "vitest";

import { FrameHandover } from "../src/net/handover";
import { FrameRing } from "../src/scene/frame_ring";

interface Numbered {
  id: number;
  buffer: ArrayBuffer;
}

function rig(maxUnderWay: number) {
  const delivered: Numbered[] = [];
  const handover = new FrameHandover<Numbered>((frame) => delivered.push(frame), maxUnderWay);
  const offer = (id: number): void => handover.offer({ id, buffer: handover.takeBuffer(8) });
  return { delivered, handover, offer };
}

describe("the hand-over to a slow page", () => {
  it("keeps the newest frame and drops those that it overtook", () => {
    const { delivered, handover, offer } = rig(2);
    for (let id = 0; id < 100; ++id) offer(id);
    expect(delivered.map(({ id }) => id)).toEqual([0, 1]);
    expect(handover.overtakenCount).toBe(97);
    handover.release(delivered[0]!.buffer);
    expect(delivered.map(({ id }) => id)).toEqual([0, 1, 99]);
    handover.release(delivered[1]!.buffer);
    expect(delivered).toHaveLength(3);
  });

  it("uses returned buffers again and makes new ones for a new size", () => {
    const { delivered, handover, offer } = rig(1);
    offer(0);
    const first = delivered[0]!.buffer;
    handover.release(first);
    expect(handover.takeBuffer(8)).toBe(first);
    expect(handover.takeBuffer(8)).not.toBe(first);
    expect(handover.takeBuffer(16).byteLength).toBe(16);
  });

  it("reuses one buffer for payloads that grow and shrink, and forgets it when told", () => {
    const handover = new FrameHandover<Numbered>(() => {}, 1, true);
    const made = handover.takeBuffer(120_000);
    expect(made.byteLength).toBe(131_072);
    for (const size of [0, 12, 60_000, 131_072, 1]) {
      handover.offer({ id: 0, buffer: made });
      handover.release(made);
      expect(handover.takeBuffer(size)).toBe(made);
    }
    handover.offer({ id: 0, buffer: made });
    handover.release(made);
    handover.forgetSpares();
    expect(handover.takeBuffer(0).byteLength).toBeGreaterThan(0);
    expect(handover.takeBuffer(200_000).byteLength).toBe(262_144);
  });

  it("is not fooled into more frames under way by buffers that nobody lent", () => {
    const { delivered, handover, offer } = rig(1);
    for (let i = 0; i < 10; ++i) handover.release(new ArrayBuffer(8));
    offer(1);
    offer(2);
    expect(delivered).toHaveLength(1);
  });
});

describe("the page's ring of frames", () => {
  const frames = (ring: FrameRing<{ timeS: number }>, ...times: number[]) => times.forEach((timeS) => ring.push({ timeS }));

  it("gives the oldest back when it is full", () => {
    const released: number[] = [];
    const ring = new FrameRing<{ timeS: number }>(3, ({ timeS }) => released.push(timeS));
    frames(ring, 1, 2, 3, 4, 5);
    expect(released).toEqual([1, 2]);
    expect(ring.newest()).toEqual({ timeS: 5 });
  });

  it("finds the frames on either side of a time", () => {
    const ring = new FrameRing<{ timeS: number }>(4, () => {});
    expect(ring.around(1)).toBeUndefined();
    frames(ring, 1, 2, 4);
    expect(ring.around(0.5)).toEqual({ from: { timeS: 1 }, to: { timeS: 1 }, mix: 0 });
    expect(ring.around(1)).toEqual({ from: { timeS: 1 }, to: { timeS: 2 }, mix: 0 });
    expect(ring.around(2.5)).toEqual({ from: { timeS: 2 }, to: { timeS: 4 }, mix: 0.25 });
    expect(ring.around(9)).toEqual({ from: { timeS: 4 }, to: { timeS: 4 }, mix: 0 });
  });

  it("starts anew when simulation time goes back", () => {
    const released: number[] = [];
    const ring = new FrameRing<{ timeS: number }>(4, ({ timeS }) => released.push(timeS));
    frames(ring, 7, 8, 0.1);
    expect(released).toEqual([7, 8]);
    expect(ring.around(8)).toEqual({ from: { timeS: 0.1 }, to: { timeS: 0.1 }, mix: 0 });
  });
});

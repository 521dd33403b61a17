import { describe, expect, it } from "vitest";

import { FrameHandover } from "../src/net/handover";
import { LinkMeter } from "../client/session/link_meter";
import { FrameRing } from "../src/scene/frames/frame_ring";

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

describe("the handover to a slow page", () => {
  it("keeps the newest frame and drops the superseded ones", () => {
    const { delivered, handover, offer } = rig(2);
    for (let id = 0; id < 100; ++id) offer(id);
    expect(delivered.map(({ id }) => id)).toEqual([0, 1]);
    expect(handover.supersededCount).toBe(97);
    handover.release(delivered[0]!.buffer);
    expect(delivered.map(({ id }) => id)).toEqual([0, 1, 99]);
    handover.release(delivered[1]!.buffer);
    expect(delivered).toHaveLength(3);
  });

  it("reuses returned buffers and makes new ones for a new size", () => {
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

  it("ignores buffers that it did not hand out", () => {
    const { delivered, handover, offer } = rig(1);
    for (let i = 0; i < 10; ++i) handover.release(new ArrayBuffer(8));
    offer(1);
    offer(2);
    expect(delivered).toHaveLength(1);
  });
});

describe("the page's ring of frames", () => {
  interface TimedState {
    timeS: number;
    stateId: bigint;
  }
  const at = (timeS: number, stateId = 0n): TimedState => ({ timeS, stateId });
  const frames = (ring: FrameRing<TimedState>, ...times: number[]) => times.forEach((timeS) => ring.push(at(timeS)));
  /** A ring and the frames that it released. */
  const noted = (maxCount: number) => {
    const released: TimedState[] = [];
    return { released, ring: new FrameRing<TimedState>(maxCount, (frame) => released.push(frame)) };
  };

  it("releases the oldest when it is full", () => {
    const { released, ring } = noted(3);
    frames(ring, 1, 2, 3, 4, 5);
    expect(released).toEqual([at(1), at(2)]);
    expect(ring.newest()).toEqual(at(5));
  });

  it("finds the frames on either side of a time", () => {
    const { ring } = noted(4);
    expect(ring.around(1)).toBeUndefined();
    frames(ring, 1, 2, 4);
    expect(ring.around(0.5)).toMatchObject({ from: at(1), to: at(1), mix: 0 });
    expect(ring.around(1)).toMatchObject({ from: at(1), to: at(2), mix: 0 });
    expect(ring.around(2.5)).toMatchObject({ from: at(2), to: at(4), mix: 0.25 });
    expect(ring.around(9)).toMatchObject({ from: at(4), to: at(4), mix: 0 });
  });

  it("finds the neighbours of those frames, as far as there are any", () => {
    const { ring } = noted(4);
    frames(ring, 1, 2, 4, 5);
    expect(ring.around(3)).toEqual({ before: at(1), from: at(2), to: at(4), after: at(5), mix: 0.5 });
    expect(ring.around(1.5)).toEqual({ before: undefined, from: at(1), to: at(2), after: at(4), mix: 0.5 });
    expect(ring.around(4.5)).toEqual({ before: at(2), from: at(4), to: at(5), after: undefined, mix: 0.5 });
  });

  it("starts again when simulation time goes back", () => {
    const { released, ring } = noted(4);
    frames(ring, 7, 8, 0.1);
    expect(released).toEqual([at(7), at(8)]);
    expect(ring.around(8)).toMatchObject({ from: at(0.1), to: at(0.1), mix: 0 });
  });

  it("replaces the newest frame with a repeated frame of a paused room", () => {
    const { released, ring } = noted(4);
    for (const frame of [at(1, 10n), at(2, 20n), at(2, 20n)]) ring.push(frame);
    expect(released).toEqual([at(2, 20n)]);
    expect(ring.around(1.5)).toMatchObject({ from: at(1, 10n), to: at(2, 20n), mix: 0.5 });
  });

  it("starts again when a paused room was changed, with or without numbered states", () => {
    for (const [before, after] of [[20n, 21n], [0n, 0n]] as const) {
      const { released, ring } = noted(4);
      for (const frame of [at(1, before && 10n), at(2, before), at(2, after)]) ring.push(frame);
      expect(released).toHaveLength(2);
      expect(ring.around(1.5)).toMatchObject({ from: at(2, after), to: at(2, after), mix: 0 });
    }
  });
});

describe("the link's meter", () => {
  it("counts the layers of one state as one frame", () => {
    const countOf = (...shown: [bigint, bigint][]): number => {
      const meter = new LinkMeter(0);
      for (const [stateId, tick] of shown) meter.frame("surface", { stateId, tick });
      return Math.round(meter.measure(1000).framesPerS / 0.6);
    };
    expect(countOf([1n, 5n], [1n, 5n], [1n, 5n])).toBe(1);
    expect(countOf([1n, 5n], [2n, 5n], [3n, 5n], [2n, 5n])).toBe(3);
    expect(countOf([0n, 5n], [0n, 5n], [0n, 6n])).toBe(2);
  });
});

import { describe, expect, it } from "vitest";

import { ServerClock } from "../client/session/server_clock";

describe("the server's clock", () => {
  it("uses the ping with the shortest round trip", () => {
    const clock = new ServerClock();
    clock.greeted(50, 1000);
    // The server is 40,000 ms ahead; the way back of the second ping took 300 ms more than the way there.
    clock.answered(2000, 42.01, 2020);
    expect(clock.leadMs()).toBeCloseTo(40_000, 6);
    clock.answered(4000, 44.01, 4320);
    expect(clock.leadMs()).toBeCloseTo(40_000, 6);
  });

  it("uses the greeting's time until the first pong, and that pong at once", () => {
    const clock = new ServerClock();
    expect(clock.leadMs()).toBeUndefined();
    clock.greeted(50, 1000);
    expect(clock.leadMs()).toBe(49_000);
    clock.answered(1000, 50.1, 1100);
    expect(clock.leadMs()).toBeCloseTo(49_050, 6);
  });

  it("corrects a small error gradually and a large one at once", () => {
    const clock = new ServerClock();
    clock.greeted(0, 0);
    clock.answered(0, 0.02, 40);
    expect(clock.leadMs()).toBeCloseTo(0, 6);
    // A shorter round trip gives 50 ms; the correction is at most 1 % of the time since then.
    clock.answered(2000, 2.055, 2010);
    expect(clock.leadMs()).toBeCloseTo(0.01 * 1970, 6);
    for (let ms = 4000; ms < 14_000; ms += 2000) clock.answered(ms, (ms + 55) / 1000, ms + 10);
    expect(clock.leadMs()).toBeCloseTo(50, 6);
    // After a laptop has slept, the pings before are too old.
    clock.answered(100_000, 400, 100_010);
    expect(clock.leadMs()).toBeCloseTo(299_995, 3);
  });

  it("ignores a pong that is older than its ping", () => {
    const clock = new ServerClock();
    clock.greeted(1, 1000);
    clock.answered(5000, 99, 4000);
    clock.answered(Number.NaN, 99, 4000);
    expect(clock.leadMs()).toBe(0);
  });
});

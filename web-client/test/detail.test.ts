import { describe, expect, it } from "vitest";

import { Layer, Level, Packing } from "../client/gen/spindrift/v1/wire_pb";
import { LoadGovernor } from "../src/net/load_governor";
import { Rig } from "./fakes";
import { greeting, surfaceFrame } from "./wire";

/** Level and `adapts` of the newest subscription to the surface. */
function asked(rig: Rig): { level: Level; adapts: boolean } {
  const { level, adapts } = rig.socket.sentOf("subscribe").filter(({ value }) => value.layer === Layer.SURFACE).at(-1)!.value;
  return { level, adapts };
}

describe("the level of detail", () => {
  it("may be lowered by the server unless the user chose it", () => {
    const rig = Rig.live();
    expect(asked(rig)).toEqual({ level: Level.FULL, adapts: true });
    rig.page.want({ detail: "medium" });
    expect(asked(rig)).toEqual({ level: Level.MEDIUM, adapts: false });
    const { length } = rig.socket.sent;
    rig.page.want({ detail: "medium" });
    expect(rig.socket.sent).toHaveLength(length);
    rig.page.want({ detail: "auto" });
    expect(asked(rig)).toEqual({ level: Level.FULL, adapts: true });
  });

  it("is reported together with what limits it", () => {
    const rig = Rig.live();
    rig.time.advance(500);
    expect(rig.lastStats()).toMatchObject({ level: "full", levelLimitedBy: "none" });
    rig.socket.deliver({ case: "levelChanged", value: { level: Level.COARSE } });
    rig.time.advance(500);
    expect(rig.lastStats()).toMatchObject({ level: "coarse", levelLimitedBy: "link" });
    rig.page.want({ detail: "fine" });
    rig.time.advance(500);
    expect(rig.lastStats()).toMatchObject({ level: "fine", levelLimitedBy: "choice" });
  });

  it("leaves the particles' packing to the page, also after a reconnection", () => {
    const rig = Rig.live();
    const ofParticles = (): Packing | undefined => rig.socket.sentOf("subscribe").filter(({ value }) => value.layer === Layer.PARTICLES).at(-1)?.value.packing;
    expect(ofParticles()).toBe(Packing.PACKED);
    rig.page.want({ exactParticles: true });
    expect(ofParticles()).toBe(Packing.PLAIN);
    expect(rig.socket.sentOf("subscribe").filter(({ value }) => value.packing === Packing.PLAIN).map(({ value }) => value.layer)).toEqual([Layer.PARTICLES]);
    const { length } = rig.socket.sent;
    rig.page.want({ exactParticles: true });
    expect(rig.socket.sent).toHaveLength(length);
    rig.reconnect();
    expect(ofParticles()).toBe(Packing.PLAIN);
    rig.page.want({ exactParticles: false });
    expect(ofParticles()).toBe(Packing.PACKED);
  });

  it("leaves the frame rate to the page, also after a reconnection, but not that of a hidden page", () => {
    const rig = Rig.live();
    const rateHz = (): number | undefined => rig.socket.sentOf("subscribe").filter(({ value }) => value.layer === Layer.SURFACE).at(-1)?.value.maxRateHz;
    const offeredHz = rateHz()!;
    expect(offeredHz).toBeGreaterThan(15);
    rig.page.want({ frameRateHz: 15 });
    expect(rateHz()).toBe(15);
    const { length } = rig.socket.sent;
    rig.page.want({ frameRateHz: 15 });
    expect(rig.socket.sent).toHaveLength(length);
    rig.reconnect();
    expect(rateHz()).toBe(15);
    rig.page.want({ visible: false });
    expect(rateHz()).toBe(0);
    rig.page.want({ visible: true });
    rig.page.want({ frameRateHz: 1000 });
    expect(rateHz()).toBe(offeredHz);
  });

  it("is unlimited again after a reconnection", () => {
    const rig = Rig.live();
    rig.socket.deliver({ case: "levelChanged", value: { level: Level.COARSE } });
    rig.reconnect();
    rig.time.advance(500);
    expect(rig.lastStats()).toMatchObject({ level: "full", levelLimitedBy: "none" });
  });

  it("becomes coarser when unpacking takes most of the time", () => {
    const rig = Rig.live();
    // Each frame takes 40 ms to read, one comes every 50 ms.
    for (let k = 0; k < 60; ++k) {
      rig.slowReadMs = 40;
      rig.socket.deliver(surfaceFrame([1, 2, 3, 4], { tick: BigInt(k) }));
      rig.time.advance(10);
    }
    expect(asked(rig)).toEqual({ level: Level.FINE, adapts: true });
    expect(rig.lastStats()).toMatchObject({ level: "fine", levelLimitedBy: "device" });
  });

  it("comes with the server's clock after the greeting and after every pong", () => {
    const rig = new Rig();
    rig.socket.open();
    rig.socket.deliver(greeting({ serverTimeS: 70 }));
    expect(rig.eventsOf("clock")).toEqual([{ kind: "clock", leadS: 69 }]);
    rig.time.advance(100);
    rig.socket.deliver({ case: "pong", value: { clientTimeS: 1, serverTimeS: 70.06 } });
    expect(rig.eventsOf("clock").at(-1)!.leadS).toBeCloseTo(69.01, 9);
  });

  it("is measured with frequent pings at first, then with one every two seconds", () => {
    const rig = Rig.live();
    rig.time.advance(2500);
    const early = rig.socket.sentOf("ping").length;
    expect(early).toBeGreaterThanOrEqual(5);
    rig.time.advance(4000);
    expect(rig.socket.sentOf("ping").length - early).toBeLessThanOrEqual(3);
  });
});

describe("the load governor", () => {
  const run = (governor: LoadGovernor, busyShare: (level: string) => number, notes: number): string[] => {
    const levels: string[] = [];
    for (let k = 0; k < notes; ++k) if (governor.note(busyShare(governor.level))) levels.push(governor.level);
    return levels;
  };

  it("steps down after two busy seconds, not after a short load", () => {
    const governor = new LoadGovernor();
    for (let k = 0; k < 30; ++k) expect(governor.note(k % 4 === 0 ? 0.1 : 0.9)).toBe(false);
    expect(run(governor, () => 0.9, 8)).toEqual(["fine", "medium"]);
  });

  it("steps up with spare time, and retries failed levels less often", () => {
    const governor = new LoadGovernor();
    run(governor, () => 0.9, 4);
    expect(governor.level).toBe("fine");
    const changes: number[] = [];
    for (let k = 0; k < 400; ++k) if (governor.note(governor.level === "full" ? 0.9 : 0.1)) changes.push(k);
    const ups = changes.filter((_, k) => k % 2 === 0);
    expect(ups.length).toBeGreaterThan(2);
    expect(ups.length).toBeLessThan(6);
    expect(run(governor, () => 0.05, 500).at(-1)).toBe("full");
  });

  it("stays within the four levels", () => {
    const governor = new LoadGovernor();
    expect(run(governor, () => 0.0, 100)).toEqual([]);
    expect(run(governor, () => 1, 100)).toEqual(["fine", "medium", "coarse"]);
  });
});

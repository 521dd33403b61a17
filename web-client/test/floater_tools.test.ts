import { describe, expect, it } from "vitest";

import { FloaterKind } from "../client/gen/spindrift/v1/scene_pb";
import { arcOf, densityName, dropOf, flickOf, floaterSizeM, throwOf, tossTo } from "../src/ui/floater_tools";
import { HoldSender, type HoldMessage } from "../src/ui/hold_sender";
import { linesOf } from "../src/ui/tool_preview";
import { kTools } from "../src/ui/tools";
import { World } from "./fakes";

const kWater = { waterExtents: { sideM: 16, longM: 20, depthM: 2 }, sideM: 20, widthM: 16, gravityMps2: 10 };
const kPlain = { sizeRatio: 1, strengthRatio: 1 };
const horizontal = ([x, , z]: readonly [number, number, number]): number => Math.hypot(x, z);

describe("the tools for objects", () => {
  it("are there only in scenes with objects, and have sizes that suit the water and that the server takes", () => {
    expect(kTools.filter(({ needsFloaters }) => needsFloaters).map(({ name }) => name)).toEqual(["float", "throw"]);
    for (const { name } of kTools) expect(floaterSizeM(name, kWater, kPlain) !== undefined, name).toBe(name === "float" || name === "throw");
    expect(floaterSizeM("float", kWater, kPlain)).toBeCloseTo(0.64, 9);
    for (const sideM of [0.3, 2, 60, 1000])
      for (const sizeRatio of [0.4, 1, 2.5])
        for (const name of ["float", "throw"] as const) {
          const sizeM = floaterSizeM(name, { ...kWater, waterExtents: { ...kWater.waterExtents, sideM } }, { sizeRatio, strengthRatio: 1 })!;
          expect(sizeM).toBeGreaterThanOrEqual(0.05);
          expect(sizeM).toBeLessThanOrEqual(Math.max(0.2 * sideM, 0.06));
        }
  });

  it("name densities", () => expect([0, 0.15, 0.7, 0.92, 2.6].map(densityName)).toEqual(["what suits its kind", "balsa", "oak", "ice", "stone"]));

  it("drop the chosen kind from over the water", () => {
    expect(dropOf("duck", { xM: 1, zM: 2 }, 0.3, 0.5, 0.7, 30, kWater)).toEqual({
      case: "spawnFloater", value: { floater: { kind: FloaterKind.DUCK, xM: 1, yM: 0.75, zM: 2, sizeM: 0.5, densityRatio: 0.7, headingDeg: 30 } },
    });
    expect(dropOf("crate", { xM: 0, zM: 0 }, 0, 1, 0, 0, kWater)).toMatchObject({ value: { floater: { kind: FloaterKind.CRATE } } });
  });

  it("throw a stone the way of the flick, faster the quicker it was, within the server's range", () => {
    const from = { xM: 1, zM: 1 };
    const flick = (toX: number, heldS: number, strengthRatio = 1) => flickOf(from, { xM: toX, zM: 1 }, heldS, 0.2, kWater, { sizeRatio: 1, strengthRatio })!;
    expect(flickOf(from, from, 0.2, 0, kWater, kPlain)).toBeUndefined();
    const quick = flick(2, 0.2);
    expect(quick.velocityMps[0]).toBeCloseTo(5, 9);
    expect(quick.velocityMps[2]).toBeCloseTo(0, 9);
    expect(quick.velocityMps[1]).toBeGreaterThan(0);
    expect(flick(0, 0.2).velocityMps[0]).toBeLessThan(0);
    expect(horizontal(flick(2, 0.4).velocityMps)).toBeCloseTo(2.5, 9);
    // A drag that aims keeps its speed.
    expect(flick(2, 9).velocityMps).toEqual(flick(2, 0.6).velocityMps);
    expect(horizontal(flick(2, 0.2, 0.5).velocityMps)).toBeCloseTo(2.5, 9);
    expect(horizontal(flick(500, 0.01).velocityMps)).toBeLessThanOrEqual(20);
    expect(throwOf(quick, 0.3, kWater)).toMatchObject({ case: "spawnFloater", value: { floater: { kind: FloaterKind.STONE, xM: 1, zM: 1, sizeM: 0.3, velocityXMps: quick.velocityMps[0], yM: quick.yM } } });
  });

  it("toss a stone gently from the camera's side to where one taps", () => {
    const toss = tossTo({ xM: 2, zM: -3 }, { xM: 2, zM: 30 }, 0.1, kWater);
    expect(toss.from.xM).toBeCloseTo(2, 9);
    expect(toss.from.zM).toBeGreaterThan(-3);
    expect(horizontal(toss.velocityMps)).toBeLessThan(5);
    const end = arcOf(toss, 0.1, kWater).at(-1)!;
    expect(end.xM).toBeCloseTo(2, 6);
    expect(end.yM).toBeCloseTo(0.1, 6);
    expect(end.zM).toBeCloseTo(-3, 6);
    // Also beside the edge that is nearest to the camera.
    const { from } = tossTo({ xM: 0, zM: 7.9 }, { xM: 0, zM: 30 }, 0, kWater);
    expect(Math.abs(from.zM)).toBeLessThanOrEqual(8);
  });

  it("show a throw's path and where it lands", () => {
    const points = arcOf({ from: { xM: 0, zM: 0 }, yM: 1, velocityMps: [3, 0, 0] }, 0, kWater);
    expect(points.at(-1)!.xM).toBeCloseTo(3 * Math.sqrt(0.2), 9);
    const [path, ring] = linesOf({ kind: "arc", points, radiusM: 0.5, color: "" });
    expect(path).toEqual(points);
    for (const { xM, zM } of ring!) expect(Math.hypot(xM - points.at(-1)!.xM, zM)).toBeCloseTo(0.5, 9);
  });
});

describe("HoldSender", () => {
  const begin = () => {
    const world = new World();
    const sent: HoldMessage[] = [];
    const lost: number[] = [];
    return { world, sent, lost, sender: new HoldSender((message) => sent.push(message), (pointerId) => lost.push(pointerId), world) };
  };

  it("pulls at once and then every 40 ms to where the pointer is then, until it lets go", () => {
    const { world, sent, sender } = begin();
    let xM = 1;
    sender.begin(5, 77, () => ({ xM, zM: 2 }));
    expect(sent).toEqual([{ floaterId: 77, xM: 1, zM: 2, turnRadps: 0 }]);
    xM = 3;
    world.pass(400);
    expect(sent).toHaveLength(11);
    expect(sent.at(-1)).toMatchObject({ xM: 3 });
    expect(sender.heldBy(5)).toBe(77);
    sender.end(5);
    sender.end(5);
    expect(sent).toHaveLength(12);
    expect(sent.at(-1)).toEqual({ floaterId: 77, xM: 3, zM: 2, ends: true });
    expect(sender.heldBy(5)).toBe(0);
    world.pass(1000);
    expect(sent).toHaveLength(12);
  });

  it("turns by the angle that was asked for, no faster than the server takes", () => {
    for (const angleRad of [0.3, -0.3, 4]) {
      const { world, sent, sender } = begin();
      sender.begin(1, 7, () => ({ xM: 0, zM: 0 }));
      sender.turn(angleRad, 1);
      world.pass(3000);
      expect(sent.reduce((sum, { turnRadps }) => sum + 0.04 * turnRadps!, 0)).toBeCloseTo(angleRad, 2);
      for (const { turnRadps } of sent) expect(Math.abs(turnRadps!)).toBeLessThanOrEqual(10);
      expect(sent.at(-1)!.turnRadps).toBe(0);
    }
  });

  it("keeps ten fingers within the commands that the server takes from a session, and often enough for each", () => {
    const { world, sent, sender } = begin();
    for (let id = 0; id < 10; ++id) sender.begin(id, id + 1, () => ({ xM: 0, zM: 0 }));
    sent.length = 0;
    world.pass(10_000);
    expect(sent.length).toBeLessThan(600);
    expect(sent.length / 10).toBeGreaterThan(10 / 0.5);
  });

  it("stops, and says so once, when the server refuses", () => {
    const { world, sent, lost, sender } = begin();
    sender.begin(1, 7, () => ({ xM: 0, zM: 0 }));
    sender.begin(2, 8, () => ({ xM: 0, zM: 0 }));
    sender.answered(1, false);
    sender.answered(2, true);
    sender.answered(99, true);
    expect(lost).toEqual([2]);
    sent.length = 0;
    world.pass(100);
    expect(new Set(sent.map(({ floaterId }) => floaterId))).toEqual(new Set([7]));
    sender.end(2);
    expect(sent.every(({ ends }) => !ends)).toBe(true);
  });
});

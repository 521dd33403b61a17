// Gauges: what the page keeps of their readings, the table that it saves, and the poles in the picture.
import { describe, expect, it } from "vitest";

import type { Display } from "../src/app/display";
import { Gauges } from "../src/app/gauges";
import type { GreetingInfo } from "../client/codec/greeting";
import type { DiagnosticsInfo } from "../client/codec/parse";
import type { GaugeInfo } from "../client/codec/scene_info";
import type { GaugeView } from "../src/gauges/gauge_view";
import { GaugeRecord, kMostTimes, type GaugeReadingInfo } from "../src/gauges/gauge_record";
import { readSeries } from "../client/rest/gauge_series";
import { bandHeightM, polesOf } from "../src/scene/solids/gauge_poles";

const reading = (name: string, elevationM: number): GaugeReadingInfo => ({ name, elevationM, velocityXMps: 2 * elevationM, velocityZMps: -elevationM });
const series = (timeS: number[], elevationM: number[]) => ({ timeS, elevationM, velocityXMps: elevationM.map((value) => 2 * value), velocityZMps: elevationM.map((value) => -value) });

describe("the record of gauges", () => {
  it("joins the history of each tick with the newest readings, without a time twice", () => {
    const record = new GaugeRecord();
    record.add(0.3, [reading("toe", 3), reading("shore", 30)]);
    record.add(0.3, [reading("toe", 3), reading("shore", 30)]);
    record.merge("toe", series([0.1, 0.2, 0.3], [1, 2, 3.5]));
    record.add(0.5, [reading("toe", 5), reading("shore", 50)]);
    record.merge("shore", series([0.2, 0.3, 0.4], [20, 30, 40]));
    expect(record.view(["toe", "shore"], "elevation")).toEqual({ timesS: [0.1, 0.2, 0.3, 0.4, 0.5], columns: [[1, 2, 3.5, null, 5], [null, 20, 30, 40, 50]] });
    expect(record.view(["shore"], "velocityX", 0.15)).toEqual({ timesS: [0.4, 0.5], columns: [[80, 100]] });
    expect(record.view(["nobody"], "velocityZ").columns).toEqual([[null, null, null, null, null]]);
  });

  it("takes nothing later than the time at which the chart is held", () => {
    const record = new GaugeRecord();
    record.add(2, [reading("toe", 2)]);
    record.merge("toe", series([1, 2, 3], [1, 2, 3]), 2);
    expect(record.view(["toe"], "elevation")).toEqual({ timesS: [1, 2], columns: [[1, 2]] });
  });

  it("begins anew when the scene does", () => {
    const record = new GaugeRecord();
    expect(record.add(7, [reading("toe", 7)])).toBe("added");
    expect(record.add(7, [reading("toe", 7)])).toBe("known");
    expect(record.add(0.1, [reading("toe", 1)])).toBe("anew");
    expect(record.view(["toe"], "elevation")).toEqual({ timesS: [0.1], columns: [[1]] });
  });

  it("keeps a bounded number of times, and of a gauge that is gone nothing in the end", () => {
    const record = new GaugeRecord();
    record.add(0, [reading("gone", 1), reading("toe", 0)]);
    for (let n = 1; n <= kMostTimes + 10; ++n) record.add(n, [reading("toe", n)]);
    const { timesS, columns } = record.view(["toe", "gone"], "elevation");
    expect([timesS.length, timesS[0], timesS.at(-1)]).toEqual([kMostTimes, 11, kMostTimes + 10]);
    expect(columns[0]).toEqual(timesS);
    expect(columns[1]!.every((value) => value === null)).toBe(true);
  });

  it("becomes a table with units in its header, and rows for the times at which a chosen gauge was read", () => {
    const record = new GaugeRecord();
    record.add(0.5, [reading("other", 9)]);
    record.add(1, [reading("toe", 0.25)]);
    record.add(1.5, [reading("toe", 0.5), reading("shore", 1)]);
    expect(record.toCsv(["toe", "shore"]).split("\n")).toEqual([
      "time [s],toe elevation [m],toe velocity x [m/s],toe velocity z [m/s],shore elevation [m],shore velocity x [m/s],shore velocity z [m/s]",
      "1,0.25,0.5,-0.25,,,",
      "1.5,0.5,1,-0.5,1,2,-1",
      "",
    ]);
    expect(record.toCsv(["toe"], 1).split("\n").slice(1)).toEqual(["1,0.25,0.5,-0.25", ""]);
  });
});

describe("the answer of the server", () => {
  const answer = { name: "toe", time_s: [1, 2], elevation_m: [0, 0.1], velocity_x_mps: [0, 0], velocity_z_mps: [0, 0] };

  it("is read, also before the first tick", () => {
    expect(readSeries(answer).elevationM).toEqual([0, 0.1]);
    expect(readSeries({ name: "toe" }).timeS).toEqual([]);
  });

  it("is refused with lists of unlike lengths, without numbers, or with times that do not ascend", () => {
    expect(() => readSeries({ ...answer, elevation_m: [0] })).toThrow("lists of 2, 1, 2, 2 numbers");
    expect(() => readSeries({ ...answer, velocity_x_mps: ["NaN", 0] })).toThrow("velocity_x_mps is not a list of numbers");
    expect(() => readSeries({ ...answer, time_s: [2, 1] })).toThrow("time_s has to ascend");
  });
});

describe("the gauges of a room", () => {
  const toe: GaugeInfo = { name: "toe", xM: 1, zM: 0 };
  const own = (gaugeId: number, xM = 2): GaugeInfo => ({ name: `G${gaugeId}`, xM, zM: 0, placed: { gaugeId, personId: 5 } });
  const greeting = (change: object = {}): GreetingInfo => ({ room: "main", sceneName: "pool", gauges: [toe], wave: {}, ...change }) as unknown as GreetingInfo;
  const diagnostics = (gaugesTimeS: number, ...gauges: object[]): DiagnosticsInfo =>
    ({ gaugesTimeS, gauges: gauges.map((gauge) => ({ gaugeId: 0, personId: 0, unread: false, zM: 0, elevationM: 0.5, ...gauge })) }) as unknown as DiagnosticsInfo;
  const g1 = { name: "G1", xM: 2, gaugeId: 1, personId: 5 };

  function rig() {
    const drawn: (readonly GaugeInfo[])[] = [];
    const told: { gauges: readonly GaugeInfo[]; isOtherWater: boolean }[] = [];
    const taken: string[][] = [];
    const view = {
      setGauges: (gauges: readonly GaugeInfo[], isOtherWater: boolean) => void told.push({ gauges, isOtherWater }),
      take: (_: number, readings: readonly GaugeReadingInfo[]) => void taken.push(readings.map(({ name }) => name)),
    } as unknown as GaugeView;
    const loads = { count: 0 };
    const display = { scene: { setGauges: (gauges: readonly GaugeInfo[]) => void drawn.push(gauges) } } as unknown as Display;
    const gauges = new Gauges(display, () => (++loads.count, Promise.resolve(view)));
    return { gauges, drawn, told, taken, loads };
  }

  it("are those of the scene and those that people have placed, as these come and go", async () => {
    const { gauges, drawn, told, loads } = rig();
    gauges.enter(greeting());
    await Promise.resolve();
    for (const change of [diagnostics(1, { name: "toe", xM: 1 }), diagnostics(1.1, { name: "toe", xM: 1 }, g1), diagnostics(1.2, { name: "toe", xM: 1 }, g1), diagnostics(1.3, { name: "toe", xM: 1 })]) gauges.take(change);
    expect(drawn).toEqual([[toe], [toe, own(1)], [toe]]);
    expect(told.map((each) => each.isOtherWater)).toEqual([true, false, false]);
    expect(loads.count).toBe(1);
  });

  it("stay while the same water continues, and are gone with another one", () => {
    const { gauges, drawn } = rig();
    gauges.enter(greeting());
    gauges.take(diagnostics(1, g1));
    gauges.enter(greeting());
    expect(drawn.at(-1)).toEqual([toe, own(1)]);
    gauges.enter(greeting({ sceneName: "sea", gauges: [] }));
    expect(drawn.at(-1)).toEqual([]);
  });

  it("have no readings before the first tick that was measured", async () => {
    const { gauges, taken } = rig();
    gauges.enter(greeting());
    await Promise.resolve();
    gauges.take(diagnostics(0, { name: "toe", xM: 1, unread: true }, { ...g1, unread: true }));
    gauges.take(diagnostics(1, { name: "toe", xM: 1 }, { ...g1, unread: true }));
    gauges.take(diagnostics(1.1, { name: "toe", xM: 1 }, g1));
    expect(taken).toEqual([["toe"], ["toe", "G1"]]);
  });

  it("are moved when the server has begun anew and gives its names again", () => {
    const { gauges, drawn } = rig();
    gauges.enter(greeting());
    gauges.take(diagnostics(9, g1));
    gauges.take(diagnostics(1, { ...g1, xM: -4 }));
    expect(drawn.at(-1)).toEqual([toe, own(1, -4)]);
  });

  it("need nothing of the page where there is no wave", () => {
    const { gauges, loads } = rig();
    gauges.enter(greeting({ gauges: [], wave: undefined }));
    expect(loads.count).toBe(0);
  });
});

describe("the poles", () => {
  const flume = { sideM: 20, widthM: 1, waterExtents: { sideM: 1, longM: 20, depthM: 0.5 }, beaches: [] } as unknown as GreetingInfo;

  it("reach from the bed to above the water", () => {
    expect(polesOf(flume, [{ name: "toe", xM: 0, zM: 0 }])).toEqual([{ name: "toe", xM: 0, zM: 0, lowM: -0.5, topM: 0.2 }]);
  });

  it("stand on land with as much above it", () => {
    const ground = { countX: 2, countZ: 1, lengthM: 20, widthM: 1, riseM: new Float32Array([-0.5, 0.25]) };
    const [pole] = polesOf({ ...flume, ground } as unknown as GreetingInfo, [{ name: "land", xM: 9, zM: 0 }]);
    expect(pole!.lowM).toBeCloseTo(0.25);
    expect(pole!.topM).toBeCloseTo(0.45);
  });

  it("have bands of a round height", () => {
    expect([0.04, 0.05, 0.12, 0.3, 0.7, 6].map(bandHeightM).map((heightM) => Number(heightM.toPrecision(3)))).toEqual([0.05, 0.05, 0.2, 0.5, 1, 10]);
  });
});

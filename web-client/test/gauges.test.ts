// Gauges: what the page keeps of their readings, the table that it saves, and the poles in the picture.
import { describe, expect, it } from "vitest";

import type { GreetingInfo } from "../src/codec/greeting";
import { GaugeRecord, kMostTimes, type GaugeReadingInfo } from "../src/gauges/gauge_record";
import { readSeries } from "../src/net/gauge_request";
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

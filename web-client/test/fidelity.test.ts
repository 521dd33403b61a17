import { readFileSync } from "node:fs";
import { join } from "node:path";
import { describe, expect, it } from "vitest";

import { fidelityName, kFidelities, wireFidelity } from "../src/codec/fidelity";
import { parse } from "../src/codec/parse";
import { Fidelity } from "../src/gen/spindrift/v1/scene_pb";
import { RoomEventKind } from "../src/gen/spindrift/v1/wire_pb";
import { describeCost, shortCost } from "../src/ui/fidelity_costs";
import { PaceWatch } from "../src/ui/pace_watch";
import { encode, greeting } from "./wire";

describe("the fidelity", () => {
  it("is read from the greeting's scene, and is balanced where a server names none", () => {
    const wave = { resolutionCount: 256, sideM: 16, depthM: 1 };
    expect(parse(encode(greeting({ scene: { wave, fidelity: Fidelity.FINE } })))).toMatchObject({ greeting: { fidelity: "fine" } });
    expect(parse(encode(greeting({ scene: { wave } })))).toMatchObject({ greeting: { fidelity: "balanced" } });
    expect(fidelityName(99 as Fidelity)).toBe("balanced");
    for (const { name } of kFidelities) expect(fidelityName(wireFidelity(name))).toBe(name);
  });

  it("has an event of its own kind when it changes", () => {
    const event = encode({ case: "roomEvent", value: { kind: RoomEventKind.FIDELITY, tick: 3n, message: "now draft" } });
    expect(parse(event)).toEqual({ kind: "roomEvent", event: "fidelity", tick: 3n, message: "now draft" });
  });
});

describe("what a level costs", () => {
  interface Row {
    knob: string;
    setting: string;
    cost_ms_per_s: number;
    height_rms_ratio: number;
  }
  interface Study {
    date: string;
    scenes: { scene: string; rows: Row[] }[];
    over_all_scenes: { setting: string; cost_ratio: number; error_ratio: number }[];
  }
  const study = JSON.parse(readFileSync(join(import.meta.dirname, "../../docs/plots/trade.json"), "utf8")) as Study;
  const short = (value: number): number => Number(value.toPrecision(2));

  it("is what the study measured, with its day", () => {
    expect(study.scenes.map(({ scene }) => scene)).toContain("harbor");
    for (const { scene, rows } of study.scenes) {
      for (const { name } of kFidelities) {
        const row = rows.find(({ knob, setting }) => knob === "fidelity" && setting === name)!;
        const { cost, error } = shortCost(scene, name);
        expect(parseFloat(cost)).toBeCloseTo(short(row.cost_ms_per_s / 1000), 9);
        expect(parseFloat(error)).toBeCloseTo(short(100 * row.height_rms_ratio), 9);
        expect(describeCost(scene, name)).toContain(`on ${study.date}: ${cost} of processor time per simulated second, water ${error} off`);
      }
    }
  });

  it("is said to be the mean over the measured scenes for the others", () => {
    for (const { setting, cost_ratio, error_ratio } of study.over_all_scenes) {
      const level = kFidelities.find(({ name }) => name === setting)!.name;
      expect(shortCost("pool", level)).toEqual({ cost: `× ${short(cost_ratio)}`, error: `× ${short(error_ratio)}` });
      if (level === "balanced") continue;
      expect(describeCost("pool", level)).toContain(`mean of ${study.scenes.length} measured scenes (${study.date})`);
      expect(describeCost("pool", level)).toContain(`${short(cost_ratio)} times the work of balanced, ${short(error_ratio)} times its error`);
    }
  });
});

describe("the note of a slow room", () => {
  it("comes after three slow seconds and goes after three at full speed", () => {
    const watch = new PaceWatch();
    const notes = [0, 1, 2, 3].map((s) => watch.note(0.62, 1, s));
    expect(notes.slice(0, 3)).toEqual(["", "", ""]);
    expect(notes[3]).toContain("62 %");
    // In between it stays: no flicker.
    expect(watch.note(0.93, 1, 10)).toContain("62 %");
    expect(watch.note(1.04, 1, 10.5)).toContain("62 %");
    expect(watch.note(1, 1, 11)).not.toBe("");
    expect(watch.note(1, 1, 14)).toBe("");
  });

  it("compares with the wanted speed, and not while paused", () => {
    const watch = new PaceWatch();
    for (let s = 0; s < 10; ++s) expect(watch.note(0.5, 0.5, s)).toBe("");
    for (let s = 10; s < 20; ++s) expect(watch.note(0, 1, s)).toBe("");
    for (let s = 20; s < 23; ++s) watch.note(1, 2, s);
    expect(watch.note(1, 2, 23)).toContain("50 %");
    watch.forget();
    expect(watch.note(1, 2, 24)).toBe("");
  });

  it("is not for a moment's hitch", () => {
    const watch = new PaceWatch();
    for (let s = 0; s < 30; ++s) expect(watch.note(s % 3 === 0 ? 1 : 0.5, 1, s)).toBe("");
  });
});

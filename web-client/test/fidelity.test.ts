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
  // The page's copy of the study's tables must not drift from them.
  const study = readFileSync(join(import.meta.dirname, "../../server/study/README.md"), "utf8");
  const rowsOf = (head: string): Map<string, string[]> => {
    const lines = study.slice(study.indexOf(head)).split("\n");
    const end = lines.findIndex((line) => !line.startsWith("|"));
    return new Map(lines.slice(2, end).map((line) => line.split("|").slice(1, -1).map((cell) => cell.trim())).map(([level, ...cells]) => [level!, cells]));
  };

  it("is what the study's table says, for the measured scenes", () => {
    const trade = rowsOf("| level | splash | breaking_wave | boat_wake | thesis | dam_break |");
    const dispersed = rowsOf("| level | splash, dispersion | splash, none |");
    ["splash", "breaking_wave", "boat_wake", "thesis", "dam_break"].forEach((scene, column) => {
      for (const { name } of kFidelities) {
        const [cost, error] = trade.get(name.toUpperCase())![column]!.match(/[\d.]+/g)!.map(Number);
        const text = describeCost(scene, name);
        expect(shortCost(scene, name)).toEqual({ cost: `${Number((cost! / 1000).toPrecision(2))} s`, error: `${error} %` });
        expect(text).toContain(`${Number((cost! / 1000).toPrecision(2))} s of two cores' time per simulated second, water ${error} % off`);
        const of_wave = { splash: 0, boat_wake: 2 }[scene];
        if (of_wave === undefined) expect(text).not.toContain("wave alone");
        else {
          const [wave_error, tick_ms] = dispersed.get(name.toUpperCase())![of_wave]!.match(/[\d.]+/g)!.map(Number);
          expect(text).toContain(`The wave alone: ${tick_ms} ms per tick, ${wave_error} % off.`);
        }
      }
    });
  });

  it("is the mean over the measured scenes for the others", () => {
    const means = rowsOf("| level | cost | error |");
    for (const { name } of kFidelities) {
      const [cost, error] = means.get(name.toUpperCase())!.map((cell) => Number(cell.replace("x", "")));
      expect(shortCost("harbor", name)).toEqual({ cost: `× ${cost}`, error: `× ${error}` });
      if (name !== "balanced") expect(describeCost("harbor", name)).toContain(`${cost} times the work of balanced, ${error} times its error`);
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

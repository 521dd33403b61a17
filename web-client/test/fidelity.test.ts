import { describe, expect, it } from "vitest";

import { fidelityName, kFidelities, wireFidelity } from "../client/codec/fidelity";
import { parse } from "../client/codec/parse";
import { Fidelity } from "../client/gen/spindrift/v1/scene_pb";
import { RoomEventKind } from "../client/gen/spindrift/v1/wire_pb";
import { describeLevel, levelTable } from "../src/ui/fidelity_texts";
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
    expect(parse(event)).toEqual({ kind: "roomEvent", event: "fidelity", tick: 3n, personId: 0, message: "now draft" });
  });
});

describe("what a level costs", () => {
  const scene = { wave: { resolutionCount: 256, sideM: 16, depthM: 1 } };
  const levelsOf = (levels: object[], errorsMeasuredOn = "") => {
    const parsed = parse(encode(greeting({ scene, fidelityLevels: { levels, errorsMeasuredOn } })));
    return parsed.kind === "greeting" ? parsed.greeting.fidelityLevels : [];
  };
  const measured = () =>
    levelsOf(
      [
        { fidelity: Fidelity.DRAFT, costMsPerS: 361.4, errorRatio: 0.3812 },
        { fidelity: Fidelity.BALANCED, costMsPerS: 1183, errorRatio: 0 },
      ],
      "2026-11-25",
    );

  it("is what the server says, with the day of the errors", () => {
    const [draft, balanced] = measured();
    expect(describeLevel(draft)).toBe("At draft, a simulated second takes this server 360 ms; the height of the water is 38 % off (measured on 2026-11-25).");
    expect(describeLevel(balanced)).toContain("takes this server 1.2 s; the height of the water is 0 % off");
    expect(levelTable(measured())).toEqual([["level", "time per second, predicted", "error"], ["draft", "360 ms", "38 %"], ["balanced", "1.2 s", "0 %"]]);
  });

  it("has no error in a scene that was not measured", () => {
    const levels = levelsOf([{ fidelity: Fidelity.FINE, costMsPerS: 99 }]);
    expect(describeLevel(levels[0])).toBe("At fine, a simulated second takes this server 99 ms. The error was not measured for this scene.");
    expect(levelTable(levels)[1]).toEqual(["fine", "99 ms", "-"]);
  });

  it("is not shown where a server does not say it", () => {
    const parsed = parse(encode(greeting({ scene })));
    expect(parsed).toMatchObject({ greeting: { fidelityLevels: [] } });
    expect(describeLevel(undefined)).toBe("");
  });

  it("leaves out levels that the page does not know and figures that are invalid", () => {
    const levels = [
      { fidelity: 99 as Fidelity, costMsPerS: 1 },
      { fidelity: Fidelity.DRAFT, costMsPerS: NaN },
      { fidelity: Fidelity.BALANCED, costMsPerS: -1 },
      { fidelity: Fidelity.FINE, costMsPerS: 7, errorRatio: Infinity },
    ];
    expect(levelsOf(levels)).toEqual([{ name: "fine", costMsPerS: 7, errorRatio: undefined, measuredOn: "" }]);
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

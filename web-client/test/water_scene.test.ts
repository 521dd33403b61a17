// The list of passes of every kind of room, with a renderer that draws nothing.
import { HalfFloatType } from "three";
import { describe, expect, it } from "vitest";

import type { GreetingInfo } from "../client/codec/greeting";
import type { SideKind, WaveInfo, WindInfo } from "../client/codec/scene_info";
import type { Frame } from "../src/net/messages";
import { chooseLook, looksOf, type LookName } from "../src/scene/looks/looks";
import type { Pass } from "../src/scene/drawing/pass";
import { kTiers, type TierName } from "../src/scene/drawing/quality";
import { WaterScene } from "../src/scene/water_scene";
import { fakeRenderer } from "./fake_renderer";

const kOpen: Record<"-x" | "+x" | "-z" | "+z", SideKind> = { "-x": "open", "+x": "open", "-z": "open", "+z": "open" };
const kWave: WaveInfo = { resolutionCount: 32, countZ: 32, sideM: 16, widthM: 16, depthM: 2, periodicX: false, periodicZ: false, sides: kOpen, spongeWidthM: 2, dampingPerS: 0, isNonlinear: false };
const kRoom = {
  layers: ["surface", "foam", "bodies", "particles"],
  sideM: 16,
  widthM: 16,
  waterExtents: { sideM: 16, longM: 16, depthM: 2 },
  waterType: "coast",
  obstacles: [],
  beaches: [],
  boats: [],
  parameters: [],
  hasParticles: false,
  hasBoats: false,
  gravityMps2: 9.81,
} as unknown as GreetingInfo;

const kWind: WindInfo = { seed: 1n, gravityMps2: 9.81, comesIn: false, levelRatio: 1, dropsPerM2S: 0.08, waveHeightM: 0.3, directionDeg: 0, speedMps: 15, fetchM: 2000 };

const kRooms: Record<string, Partial<GreetingInfo>> = {
  "an open sea with boats": { wave: kWave, setting: "openSea", hasBoats: true, hasBreakers: true },
  "a harbor with everything": {
    wave: { ...kWave, sides: { ...kOpen, "-z": "closed" } },
    setting: "openSea",
    hasParticles: true,
    hasBoats: true,
    hasFloaters: true,
    obstacles: [{ shape: "rock", xM: 2, zM: 2, radiusM: 1, heightM: 1 }],
    wind: kWind,
  },
  "a beach where water runs up": {
    wave: { ...kWave, isNonlinear: true, sides: { ...kOpen, "+x": "closed" } },
    setting: "openSea",
    beaches: [{ side: "+x", widthM: 6, shoreDepthM: -1 }],
    obstacles: [{ shape: "rock", xM: 2, zM: 2, radiusM: 1, heightM: 1 }],
  },
  "a pool": { wave: kWave, setting: "pool", hasParticles: true },
  "a tank of particles": { setting: "glassTank", hasParticles: true },
  "a flume": { wave: kWave, setting: "flume", wind: kWind },
};

/** Returns the passes of a room in every look that it has data for. */
function passesOf(change: Partial<GreetingInfo>, quality: TierName): Map<LookName, Pass[]> {
  const greeting = { ...kRoom, ...change };
  const scene = new WaterScene(fakeRenderer(), { ...kTiers[quality], texelType: HalfFloatType }, () => {});
  scene.enter(greeting, false);
  const lists = new Map<LookName, Pass[]>();
  for (const look of looksOf(greeting)) {
    scene.setLook(look);
    const drawn: Pass[] = [];
    scene.render(1, (pass) => drawn.push(pass));
    lists.set(look, drawn);
  }
  scene.dispose();
  return lists;
}

/** Meshes of high quality take seconds on a busy machine. */
const kLongestMs = 120_000;
const kLow = Object.entries(kRooms).map(([room, change]) => ({ room, change, lists: passesOf(change, "low") }));
const kLists = kLow.flatMap(({ room, lists }) => [...lists].map(([look, passes]): [string, LookName, Pass[]] => [room, look, passes]));

describe.each(kLists)("the passes of %s in the look %s", (_, __, passes) => {
  it("read what passes before them wrote", () => {
    passes.forEach((pass, at) => {
      for (const read of pass.reads) {
        // The canvas is cleared before the first pass. What nobody writes is not there in this room, or comes from the server.
        const first = passes.findIndex((writer) => writer.writes.includes(read));
        if (read !== "canvas" && first >= 0) expect(first, `${pass.name} reads ${read}`).toBeLessThan(at);
      }
    });
  });

  it("write nothing that no later pass reads, except the canvas", () => {
    passes.forEach((pass, at) => {
      for (const written of pass.writes)
        if (written !== "canvas") expect(passes.slice(at + 1).some((later) => later.reads.includes(written)), `${pass.name} writes ${written}`).toBe(true);
    });
  });

  it("have names of their own", () => {
    const names = passes.map(({ name }) => name);
    expect(new Set(names).size).toBe(names.length);
  });
});

const namesOf = (lists: Map<LookName, Pass[]>): [LookName, string[]][] => [...lists].map(([look, passes]) => [look, passes.map(({ name }) => name)]);

describe.each(kLow)("the lists of passes of $room", ({ change, lists }) => {
  it("differ between the qualities by caustics, shadows, rings of rain, ripples, bubbles and smooth edges alone", { timeout: kLongestMs }, () => {
    const high = namesOf(passesOf(change, "high"));
    const isShared = (name: string): boolean => !["caustics", "edges", "bubbles", "rain rings", "sea", "shadow", "flat shadow"].includes(name);
    expect(high.map(([look, names]) => [look, names.filter(isShared)])).toEqual(namesOf(lists).map(([look, names]) => [look, names.filter(isShared)]));
    for (const [look, names] of high) {
      expect(names.includes("edges")).toBe(look === "natural");
      expect(names).toContain("shadow");
      expect(names).not.toContain("flat shadow");
      expect(names.includes("caustics")).toBe(names.includes("field"));
      expect(names.includes("rain rings")).toBe(names.includes("rain streaks"));
    }
    for (const [look, names] of namesOf(lists)) {
      expect(names).not.toContain("shadow");
      expect(names.includes("flat shadow")).toBe(look === "natural" && names.includes("field"));
    }
  });
});

describe("the list of passes", () => {
  it("holds only what the room needs", { timeout: kLongestMs }, () => {
    const names = (change: Partial<GreetingInfo>): string[] => passesOf(change, "low").get("natural")!.map(({ name }) => name);
    expect(names(kRooms["an open sea with boats"]!)).toEqual(["waterlines", "field", "foam", "sea", "solids", "whitewater", "froth", "flat shadow", "water", "present", "spray", "lamps"]);
    expect(names({ ...kRooms["a pool"], layers: ["surface"], hasParticles: false })).toEqual(["field", "solids", "whitewater", "froth", "flat shadow", "water", "present", "spray"]);
    expect(names(kRooms["a harbor with everything"]!)).toContain("rain streaks");
    expect(names(kRooms["a flume"]!)).toContain("rain streaks");
    expect(names(kRooms["a beach where water runs up"]!).slice(0, 3)).toEqual(["field", "shore", "foam"]);
    expect(names(kRooms["a harbor with everything"]!)).not.toContain("shore");
    const tank = names(kRooms["a tank of particles"]!);
    expect(tank.slice(0, 5)).toEqual(["solids", "particles", "fluid volume", "fluid shadow", "present"]);
    expect(tank.at(-1)).toBe("glass");
  });
});

describe("a new greeting", () => {
  const frame = (timeS: number): Frame => ({
    layer: "surface", tick: 0n, stateId: BigInt(Math.round(timeS * 60)), timeS, serverTimeS: timeS, level: "full", resolutionCount: 32, countZ: 32, sideM: 16, widthM: 16, quantumM: 0.001, buffer: new ArrayBuffer(2048),
  });

  it("keeps the frames of the same water at another fidelity, and returns those of other water", () => {
    const released: Frame[] = [];
    const scene = new WaterScene(fakeRenderer(), { ...kTiers.low, texelType: HalfFloatType }, (given) => released.push(given));
    const sea = { ...kRoom, ...kRooms["an open sea with boats"] };
    scene.enter(sea, false);
    const [first, second] = [frame(1), frame(1.1)];
    scene.take(first, 1);
    scene.take(second, 1.1);
    scene.enter({ ...sea, wave: { ...kWave, resolutionCount: 64, countZ: 64 } }, true);
    expect(scene.newestSurface()).toBe(second);
    expect(released).toEqual([]);
    scene.enter({ ...sea, sceneName: "other" }, false);
    expect(scene.newestSurface()).toBeUndefined();
    expect(released).toEqual([first, second]);
    scene.dispose();
  });
});

describe("wet ground", () => {
  const beach: GreetingInfo = { ...kRoom, ...kRooms["a beach where water runs up"]! };
  const frame = (timeS: number, elevationM: number): Frame => ({
    layer: "surface", tick: 0n, stateId: BigInt(Math.round(timeS * 60)), timeS, serverTimeS: timeS, level: "full", resolutionCount: 32, countZ: 32, sideM: 16, widthM: 16, quantumM: 0.001,
    buffer: new Int16Array(1024).fill(1000 * elevationM).buffer,
  });
  /** The last frame is the one shown; a sample of 2 m over the sand is a wave over all of it. */
  const shownAfter = (frames: Frame[]): WaterScene => {
    const scene = new WaterScene(fakeRenderer(), { ...kTiers.low, texelType: HalfFloatType }, () => {});
    scene.enter(beach, false);
    for (const each of frames) {
      scene.take(each, each.timeS);
      scene.clock.hold(each.timeS);
      scene.render(each.timeS);
    }
    return scene;
  };

  it("is where water was, also in another quality, and not in another room", () => {
    const scene = shownAfter([frame(1, 2), frame(1.1, -0.5)]);
    expect(scene.shoreAt(7.5, 0)!.wetness).toBeGreaterThan(0.9);
    scene.setQuality({ ...kTiers.low, surfaceCellsCount: 64, texelType: HalfFloatType });
    scene.render(1.1);
    expect(scene.shoreAt(7.5, 0)!.wetness).toBeGreaterThan(0.9);
    scene.enter({ ...beach, sceneName: "other" }, false);
    expect(scene.shoreAt(7.5, 0)).toBeUndefined();
    scene.dispose();
  });

  it("is dry for one who comes after the wave", () => {
    const scene = shownAfter([frame(1.1, -0.5)]);
    expect(scene.shoreAt(7.5, 0)).toEqual({ wetness: 0, foam: 0 });
    expect(scene.shoreAt(-7.5, 0)!.wetness).toBe(1);
    scene.dispose();
  });
});

describe("the look of the water", () => {
  const names = (scene: WaterScene): string[] => {
    const drawn: string[] = [];
    scene.render(1, ({ name }) => drawn.push(name));
    return drawn;
  };

  it("is one that the room has data for", () => {
    const of = (change: Partial<GreetingInfo>): LookName[] => looksOf({ ...kRoom, ...change });
    expect(of({ wave: kWave, hasBreakers: true })).toEqual(["natural", "height", "velocity", "breaking", "foam", "thesis"]);
    expect(of({ wave: kWave, hasBreakers: true, gravityMps2: 0 })).not.toContain("breaking");
    expect(of({ wave: kWave, layers: ["surface"] })).toEqual(["natural", "height", "velocity", "thesis"]);
    expect(of({ hasParticles: true })).toEqual(["natural", "speed", "density", "thesis"]);
  });

  it("comes from the address, if there is one of this name", () => {
    expect(chooseLook("?quality=low&look=speed")).toBe("speed");
    for (const search of ["", "?look=", "?look=toString", "?look=HEIGHT"]) expect(chooseLook(search)).toBe("natural");
  });

  it("stays in the next room, after a lost context, and after a room without its data", { timeout: kLongestMs }, () => {
    const scene = new WaterScene(fakeRenderer(), { ...kTiers.low, texelType: HalfFloatType }, () => {});
    const room = (name: string): GreetingInfo => ({ ...kRoom, ...kRooms[name]! });
    scene.enter(room("a pool"), false);
    scene.setLook("height");
    const inPool = names(scene);
    expect(inPool).toEqual(["field", "solids", "look value", "look surface", "present"]);
    expect(scene.legend?.quantity.unit).toBe("m");
    scene.contextRestored();
    expect(names(scene)).toEqual(inPool);
    scene.enter(room("a tank of particles"), false);
    expect(scene.look).toBe("natural");
    expect(scene.legend).toBeUndefined();
    expect(names(scene)).toContain("fluid surface");
    scene.enter(room("a harbor with everything"), false);
    expect(scene.look).toBe("height");
    scene.setLook("thesis");
    expect(names(scene)).toEqual(["waterlines", "field", "sea", "solids", "particles", "look surface", "look particles", "present"]);
    scene.setLook("natural");
    expect(names(scene)).toContain("water");
    scene.dispose();
  });

  it("reads no value before the first frame", () => {
    const scene = new WaterScene(fakeRenderer(), { ...kTiers.low, texelType: HalfFloatType }, () => {});
    scene.setLook("velocity");
    scene.enter({ ...kRoom, ...kRooms["a pool"]! }, false);
    scene.render(1);
    expect(scene.probe({ originM: [0, 5, 0], direction: [0, -1, 0] })).toBeUndefined();
    scene.dispose();
  });
});

describe("programs before the first picture", () => {
  it.each([["minimal", 2], ["high", 0]] as const)("are linked while the room is built, in %s drawn with %i times, and not again for a second room", (tier, drawsCount) => {
    const calls: string[] = [];
    const renderer = fakeRenderer({ compile: () => void calls.push("compile"), render: () => void calls.push("render") });
    const scene = new WaterScene(renderer, { ...kTiers[tier], texelType: HalfFloatType }, () => {});
    scene.enter({ ...kRoom, ...kRooms["a harbor with everything"] }, false);
    expect(calls.filter((call) => call === "compile")).toHaveLength(2);
    expect(calls.filter((call) => call === "render")).toHaveLength(drawsCount);
    calls.length = 0;
    scene.enter({ ...kRoom, ...kRooms["a pool"] }, false);
    expect(calls).toEqual([]);
    scene.dispose();
  });
});

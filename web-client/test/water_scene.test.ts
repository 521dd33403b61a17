// The list of passes of every kind of room, with a renderer that draws nothing.
import { WebGLCoordinateSystem, type WebGLRenderer } from "three";
import { describe, expect, it } from "vitest";

import type { GreetingInfo } from "../src/codec/greeting";
import type { SideKind, WaveInfo } from "../src/codec/scene_info";
import type { Frame } from "../src/net/messages";
import type { Pass } from "../src/scene/passes/pass";
import { chooseQuality } from "../src/scene/quality";
import { WaterScene } from "../src/scene/water_scene";

/** Takes every call; only what WaterScene reads has a value. */
function fakeRenderer(): WebGLRenderer {
  const values: Record<string, unknown> = { xr: { enabled: false }, coordinateSystem: WebGLCoordinateSystem, autoClear: true };
  return new Proxy(values, {
    get: (target, key: string) => (key in target ? target[key] : () => null),
    set: (target, key: string, value) => ((target[key] = value), true),
  }) as unknown as WebGLRenderer;
}

const kOpen: Record<"-x" | "+x" | "-z" | "+z", SideKind> = { "-x": "open", "+x": "open", "-z": "open", "+z": "open" };
const kWave: WaveInfo = { resolutionCount: 32, sideM: 16, depthM: 2, periodicX: false, periodicZ: false, sides: kOpen, spongeWidthM: 2, dampingPerS: 0 };
const kRoom = {
  layers: ["surface", "foam", "bodies", "particles"],
  sideM: 16,
  widthM: 16,
  waterExtents: { sideM: 16, depthM: 2 },
  obstacles: [],
  beaches: [],
  boats: [],
  parameters: [],
  hasParticles: false,
  hasBoats: false,
} as unknown as GreetingInfo;

const kRooms: Record<string, Partial<GreetingInfo>> = {
  "an open sea with boats": { wave: kWave, setting: "openSea", hasBoats: true },
  "a harbor with everything": {
    wave: { ...kWave, sides: { ...kOpen, "-z": "closed" } },
    setting: "openSea",
    hasParticles: true,
    hasBoats: true,
    obstacles: [{ shape: "rock", xM: 2, zM: 2, radiusM: 1, heightM: 1 }],
  },
  "a pool": { wave: kWave, setting: "pool", hasParticles: true },
  "a tank of particles": { setting: "glassTank", hasParticles: true },
  "a flume": { wave: kWave, setting: "flume" },
};

function enter(change: Partial<GreetingInfo>, quality: "low" | "high"): Pass[] {
  const scene = new WaterScene(fakeRenderer(), chooseQuality(`?quality=${quality}`, ""), () => {});
  scene.enter({ ...kRoom, ...change }, false);
  const drawn: Pass[] = [];
  scene.render(1, (pass) => drawn.push(pass));
  scene.dispose();
  return drawn;
}

const kRoomsAndQualities = Object.entries(kRooms).flatMap(([name, change]) => {
  const [low, high] = [enter(change, "low"), enter(change, "high")];
  return [{ name, quality: "low", passes: low, others: high }, { name, quality: "high", passes: high, others: low }];
});

describe.each(kRoomsAndQualities)("the passes of $name at $quality quality", ({ quality, passes, others }) => {

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

  it("have names of their own, and only caustics and shadows differ between the qualities", () => {
    const names = passes.map(({ name }) => name);
    expect(new Set(names).size).toBe(names.length);
    const isShared = (name: string): boolean => !["caustics", "shadow", "flat shadow"].includes(name);
    expect(others.map(({ name }) => name).filter(isShared)).toEqual(names.filter(isShared));
    expect(names.includes("caustics")).toBe(quality === "high" && names.includes("field"));
    expect(names.includes("shadow")).toBe(quality === "high");
    expect(names.includes("flat shadow")).toBe(quality === "low" && names.includes("field"));
  });
});

describe("the list of passes", () => {
  it("holds only what the room needs", () => {
    const names = (change: Partial<GreetingInfo>): string[] => enter(change, "low").map(({ name }) => name);
    expect(names(kRooms["an open sea with boats"]!)).toEqual(["field", "foam", "sea", "solids", "whitewater", "froth", "bubbles", "flat shadow", "water", "present", "spray", "lamps"]);
    expect(names({ ...kRooms["a pool"], layers: ["surface"], hasParticles: false })).toEqual(["field", "solids", "whitewater", "froth", "bubbles", "flat shadow", "water", "present", "spray"]);
    const tank = names(kRooms["a tank of particles"]!);
    expect(tank.slice(0, 4)).toEqual(["solids", "particles", "fluid shadow", "present"]);
    expect(tank.at(-1)).toBe("glass");
  });
});

describe("a new greeting", () => {
  const frame = (timeS: number): Frame => ({
    layer: "surface", tick: 0n, stateId: BigInt(Math.round(timeS * 60)), timeS, serverTimeS: timeS, level: "full", resolutionCount: 32, sideM: 16, quantumM: 0.001, buffer: new ArrayBuffer(2048),
  });

  it("keeps the frames of the same water at another fidelity, and returns those of other water", () => {
    const released: Frame[] = [];
    const scene = new WaterScene(fakeRenderer(), chooseQuality("?quality=low", ""), (given) => released.push(given));
    const sea = { ...kRoom, ...kRooms["an open sea with boats"] };
    scene.enter(sea, false);
    const [first, second] = [frame(1), frame(1.1)];
    scene.take(first, 1);
    scene.take(second, 1.1);
    scene.enter({ ...sea, wave: { ...kWave, resolutionCount: 64 } }, true);
    expect(scene.newestSurface()).toBe(second);
    expect(released).toEqual([]);
    scene.enter({ ...sea, sceneName: "other" }, false);
    expect(scene.newestSurface()).toBeUndefined();
    expect(released).toEqual([first, second]);
    scene.dispose();
  });
});

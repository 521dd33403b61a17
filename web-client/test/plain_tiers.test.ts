// What a picture of the plain tiers may cost, counted: draw calls, targets, vertices, and the textures that a pixel reads. A software renderer pays
// for each of them.
import { FloatType, type Object3D, type Vector2, type WebGLRenderTarget } from "three";
import { describe, expect, it } from "vitest";

import type { GreetingInfo } from "../client/codec/greeting";
import type { ParticleFrame } from "../src/net/messages";
import { firstTier, kTiers, type TierName } from "../src/scene/drawing/quality";
import fluidPlain from "../src/scene/shaders/fluid_plain.frag?raw";
import fluidPlainDrop from "../src/scene/shaders/fluid_plain_drop.frag?raw";
import fluidPlainFloor from "../src/scene/shaders/fluid_plain_floor.frag?raw";
import skyPlain from "../src/scene/shaders/sky_plain.frag?raw";
import solidPlain from "../src/scene/shaders/solid_plain.frag?raw";
import waterPlain from "../src/scene/shaders/water_plain.frag?raw";
import { cellsAlong, gridLines } from "../src/scene/water/water_grid";
import { WaterScene } from "../src/scene/water_scene";
import { fakeRenderer } from "./fake_renderer";

const kSizePx = [1280, 720] as const;
const kOpen = { "-x": "open", "+x": "open", "-z": "closed", "+z": "open" } as const;
/** An open sea with all that is drawn on one: boats, objects, rocks, wind, and particles. */
const kHarbor = {
  layers: ["surface", "foam", "bodies", "particles"],
  setting: "openSea",
  sideM: 16,
  widthM: 16,
  waterExtents: { sideM: 16, longM: 16, depthM: 2 },
  waterType: "coast",
  wave: { resolutionCount: 192, countZ: 192, sideM: 16, widthM: 16, depthM: 2, periodicX: false, periodicZ: false, sides: kOpen, spongeWidthM: 2, dampingPerS: 0, isNonlinear: false },
  wind: { seed: 1n, gravityMps2: 9.81, comesIn: false, levelRatio: 1, dropsPerM2S: 0, waveHeightM: 0.3, directionDeg: 0, speedMps: 15, fetchM: 2000 },
  obstacles: [{ shape: "rock", xM: 2, zM: 2, radiusM: 1, heightM: 1 }],
  beaches: [],
  boats: [],
  parameters: [],
  hasParticles: true,
  hasBoats: true,
  hasFloaters: true,
  gravityMps2: 9.81,
} as unknown as GreetingInfo;

/** A tank of particles. */
const kTank = {
  ...kHarbor,
  layers: ["particles"],
  setting: "glassTank",
  sideM: 4,
  widthM: 0.8,
  waterExtents: { sideM: 4, longM: 4, depthM: 2 },
  wave: undefined,
  wind: undefined,
  obstacles: [],
  hasBoats: false,
  hasFloaters: false,
} as unknown as GreetingInfo;

/** Particles that fill the lower half of the tank's left part, and one high above them. */
function tankFrame(timeS: number, n: number): ParticleFrame {
  const perAxis = 12;
  const count = perAxis ** 3 + 1;
  const words = new Uint16Array(count * 6);
  for (let at = 0; at + 1 < count; ++at) words.set([at % perAxis, Math.floor(at / perAxis) % perAxis, Math.floor(at / perAxis ** 2)].map((place) => 1 + (place * 30_000) / perAxis), 6 * at);
  words.set([40_000, 30_000, 65_535], 6 * (count - 1));
  const [minM, maxM] = [[-2, 0, -0.4], [2, 2, 0.4]] as [[number, number, number], [number, number, number]];
  return { layer: "particles", tick: 0n, stateId: BigInt(n + 1), timeS, serverTimeS: timeS, level: "full", count, minM, maxM, wordMinM: minM, wordMaxM: maxM, maxSpeedMps: 1, radiusM: 0.04, buffer: words.buffer } as unknown as ParticleFrame;
}

interface Draw {
  /** Undefined: the canvas. */
  targetPx: number | undefined;
  materials: Set<string>;
}

/** Notes every call that draws, in the pictures after the first, whose light is baked; in the first one alone with a `picturesCount` of 0. */
function drawsOf(tier: TierName, picturesCount: number, room = kHarbor): Draw[] {
  const draws: Draw[] = [];
  let target: WebGLRenderTarget | null = null;
  const renderer = fakeRenderer({
    getDrawingBufferSize: (size: Vector2) => size.set(...kSizePx),
    getRenderTarget: () => target,
    setRenderTarget: (next: WebGLRenderTarget | null) => void (target = next),
    render: (scene: Object3D) => {
      const materials = new Set<string>();
      scene.traverseVisible((object) => materials.add(((object as { material?: { name: string } }).material?.name ?? "")));
      materials.delete("");
      draws.push({ targetPx: target ? target.width * target.height : undefined, materials });
    },
  });
  const scene = new WaterScene(renderer, { ...kTiers[tier], texelType: FloatType }, () => {});
  scene.enter(room, false);
  draws.length = 0;
  scene.camera.position.set(0, 5, 20);
  for (let n = 0; n <= picturesCount; ++n) {
    const timeS = 1 + 0.1 * n;
    const resolutionCount = kHarbor.wave!.resolutionCount;
    if (!room.wave) scene.take(tankFrame(timeS, n), timeS);
    else scene.take({ layer: "surface", tick: 0n, stateId: BigInt(n + 1), timeS, serverTimeS: timeS, level: "full", resolutionCount, countZ: resolutionCount, sideM: 16, widthM: 16, quantumM: 0.001, buffer: new ArrayBuffer(2 * resolutionCount ** 2) }, timeS);
    scene.clock.hold(timeS);
    scene.render(timeS);
    if (n === 0 && picturesCount > 0) draws.length = 0;
  }
  scene.dispose();
  return draws;
}

/** Returns the lines of a shader that remain with these defines. */
function preprocessed(text: string, defines: readonly string[]): string {
  const kept: boolean[] = [];
  return text
    .split("\n")
    .filter((line) => {
      const [, directive, condition = ""] = /^#(ifdef|ifndef|if|else|endif)\b\s*(.*)/.exec(line) ?? [];
      if (directive === "endif") kept.pop();
      else if (directive === "else") kept.push(!kept.pop()!);
      else if (directive) kept.push((condition.match(/\w+/g) ?? []).filter((word) => word !== "defined").some((name) => defines.includes(name)) !== (directive === "ifndef"));
      return !directive && kept.every(Boolean);
    })
    .join("\n")
    .replace(/\/\/.*$/gm, "");
}

const readsOf = (text: string, ...defines: string[]): number => preprocessed(text, defines).match(/\btexture(Lod)?\(|\btexelFetch\(/g)?.length ?? 0;

describe("a picture in the tier minimal", () => {
  const draws = drawsOf("minimal", 2);

  it("takes few draws, fewer than the tiers above", () => {
    expect(draws.length / 2).toBeLessThanOrEqual(6);
    expect(draws.length).toBeLessThan(drawsOf("low", 2).length);
  });

  it("has no picture between the scene and the canvas", () => {
    const largestPx = Math.max(...draws.map(({ targetPx }) => targetPx ?? 0));
    expect(largestPx).toBeLessThanOrEqual(kTiers.minimal.whitewater.frothTexelsCount ** 2);
    // The same count finds the one of a higher tier.
    expect(Math.max(...drawsOf("medium", 1).map(({ targetPx }) => targetPx ?? 0))).toBeGreaterThanOrEqual(kSizePx[0] * kSizePx[1]);
  });

  it("draws solids, water and sky with the plain programs alone", () => {
    const onCanvas = new Set(draws.filter(({ targetPx }) => targetPx === undefined).flatMap(({ materials }) => [...materials]));
    for (const name of ["solidPlain", "waterPlain", "skyPlain"]) expect(onCanvas).toContain(name);
    for (const name of ["solid", "water", "skyDome", "present"]) expect(onCanvas).not.toContain(name);
  });

  it("draws a channel with cells that are about as long as wide, as many as a square's", () => {
    for (const [sideM, widthM] of [[20, 1], [1, 20], [7, 7], [16, 9]] as const) {
      const [cellsX, cellsZ] = cellsAlong(96, { sideM, widthM });
      const ratio = (sideM / cellsX) / (widthM / cellsZ);
      expect(ratio).toBeGreaterThan(0.9);
      expect(ratio).toBeLessThan(1.1);
      expect(cellsX * cellsZ).toBeGreaterThan(0.95 * 96 * 96);
      expect(cellsX * cellsZ).toBeLessThan(1.05 * 96 * 96);
    }
    expect(cellsAlong(96, { sideM: 1000, widthM: 1 })[1]).toBe(8);
  });

  it("has a grid of few vertices", () => {
    const lines = gridLines(kTiers.minimal.surfaceCellsCount, true, true).length;
    expect(lines ** 2).toBeLessThanOrEqual(6000);
    expect(gridLines(kTiers.minimal.surfaceCellsCount, true, true)[0]).toBeLessThan(-100);
  });
});

describe("the first picture without graphics hardware", () => {
  it("is drawn in the cheapest tier, with few programs and small targets", () => {
    const tier = firstTier(true, false);
    expect(tier).toBe("minimal");
    for (const room of [kHarbor, kTank]) {
      const draws = drawsOf(tier, 0, room);
      const programs = new Set(draws.flatMap(({ materials }) => [...materials]));
      expect(programs.size).toBeGreaterThan(4);
      expect(programs.size).toBeLessThanOrEqual(9);
      // The sky is baked into six faces of 128 x 128 texels.
      expect(draws.reduce((sum, { targetPx }) => sum + (targetPx ?? 0), 0)).toBeLessThanOrEqual(6 * 128 ** 2 + 40_000);
      expect(draws.filter(({ targetPx }) => targetPx === undefined).length).toBeLessThanOrEqual(4);
    }
  });
});

describe("a picture of a tank of particles in the tier minimal", () => {
  const draws = drawsOf("minimal", 2, kTank);

  it("takes at most four draws, straight onto the canvas", () => {
    expect(draws.length / 2).toBeLessThanOrEqual(4);
    // The solids' textures are emptied in the first picture.
    for (const { targetPx } of draws) expect(targetPx ?? 0).toBe(0);
    // The same count finds the volume and the picture of the liquid of the tier above.
    expect(drawsOf("low", 2, kTank).filter(({ targetPx }) => (targetPx ?? 0) > 1000).length).toBeGreaterThan(4);
  });

  it("has the mesh of the liquid, and none of the programs that search for its surface", () => {
    const names = new Set(draws.flatMap(({ materials }) => [...materials]));
    for (const name of ["fluidPlain", "fluidPlainDrop", "fluidPlainFloor", "solidPlain", "skyPlain", "glass"]) expect(names).toContain(name);
    expect([...names].filter((name) => name.startsWith("fluid") && !name.startsWith("fluidPlain"))).toEqual([]);
  });
});

describe("a pixel of the plain programs", () => {
  it("reads at most two textures, and the ripples of a sea twice", () => {
    expect(readsOf(waterPlain, "OPEN_SEA", "BEACH", "SHORE", "FOAM")).toBe(3);
    expect(readsOf(waterPlain, "FOAM")).toBeLessThanOrEqual(2);
    expect(readsOf(waterPlain, "SKIRT")).toBe(1);
    expect(readsOf(waterPlain, "OPEN_SEA", "DIVED")).toBeGreaterThan(3);
    expect(readsOf(fluidPlain)).toBe(2);
    expect(readsOf(solidPlain)).toBe(1);
    for (const text of [fluidPlainDrop, fluidPlainFloor]) expect(readsOf(text)).toBe(0);
    expect(readsOf(skyPlain)).toBe(0);
  });

  it("does not branch, because both sides would be executed, except to discard a pixel", () => {
    for (const text of [waterPlain, solidPlain, skyPlain, fluidPlain, fluidPlainDrop, fluidPlainFloor]) expect(preprocessed(text, ["OPEN_SEA", "BEACH", "FOAM"])).not.toMatch(/\b(for|while)\s*\(|\bif\s*\((?!.*\) discard;)/);
  });
});

// The sea outside the simulated square: its waves, their tiles, the blend, the grid and the coast.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { describe, expect, it } from "vitest";

import { kSideNames, type SideKind, type SideName, type WaveInfo, type WindInfo } from "../client/codec/scene_info";
import { coastHeightM, makeCoastGeometry, quayHeightM } from "../src/scene/landscape/coast";
import { blendOf } from "../src/scene/sea/open_sea";
import { makeRipples, rippleSlope, tornByWind } from "../src/scene/sea/ripples";
import { fitToTile, slopeVariance } from "../src/scene/sea/sea_tile";
import { seaStateOf, waveFrequencyRadps } from "../src/scene/sea/sea_state";
import { gridLines } from "../src/scene/water/water_grid";

const sidesOf = (plusX: SideKind, minusX: SideKind, plusZ: SideKind, minusZ: SideKind): Record<SideName, SideKind> => ({ "+x": plusX, "-x": minusX, "+z": plusZ, "-z": minusZ });

// As openSea() in tests/unit/sim_setup/sea_state_test.cpp.
const wave: WaveInfo = {
  resolutionCount: 256, countZ: 256, sideM: 30, widthM: 30, depthM: 2, periodicX: false, periodicZ: false,
  sides: sidesOf("open", "open", "open", "open"), spongeWidthM: 4, dampingPerS: 0.1, isNonlinear: false,
};
const wind: WindInfo = { seed: 7n, gravityMps2: 9.81, comesIn: true, levelRatio: 1, dropsPerM2S: 0.08, waveHeightM: 1, directionDeg: 30, speedMps: 15, fetchM: 2000 };

const varianceOf = (waves: readonly { amplitudeM: number }[]): number => waves.reduce((sum, { amplitudeM }) => sum + amplitudeM ** 2 / 2, 0);

describe("the wind sea outside", () => {
  it("has the server's waves: amplitude, frequency, wave number and phase", () => {
    const kept = readFileSync(join(import.meta.dirname, "../../tests/golden/sea_waves.txt"), "utf8").trim().split("\n").map((line) => line.split(" ").map(Number));
    const waves = seaStateOf(wave, wind);
    expect(kept.length).toBe(32);
    expect(waves.length).toBe(kept.length);
    waves.forEach(({ amplitudeM, omegaRadps, kxRadpm, kzRadpm, phaseRad }, n) => {
      [amplitudeM, omegaRadps, kxRadpm, kzRadpm, phaseRad].forEach((value, at) => expect(value, `wave ${n}`).toBeCloseTo(kept[n]![at]!, 8));
    });
  });

  it("is calm at level 0, without wind, and with the wind from closed sides", () => {
    expect(seaStateOf(wave, { ...wind, levelRatio: 0 })).toEqual([]);
    expect(seaStateOf(wave, { ...wind, speedMps: 0 })).toEqual([]);
    expect(seaStateOf({ ...wave, sides: sidesOf("open", "closed", "closed", "closed") }, { ...wind, directionDeg: 0 })).toEqual([]);
  });

  it("grows with the storm and obeys Airy's relation", () => {
    const low = seaStateOf(wave, { ...wind, levelRatio: 0.3 });
    const high = seaStateOf(wave, wind);
    expect(varianceOf(low)).toBeGreaterThan(0);
    expect(varianceOf(high)).toBeGreaterThan(varianceOf(low));
    for (const { kxRadpm, kzRadpm, omegaRadps } of high)
      expect(omegaRadps).toBeCloseTo(waveFrequencyRadps(Math.hypot(kxRadpm, kzRadpm), 9.81, 2), 12);
  });

  it("keeps a wave's direction and length on a tile to less than one wave per tile", () => {
    for (const each of seaStateOf(wave, wind)) {
      const { columnsCount, rowsCount } = fitToTile(each, 60);
      expect(Number.isInteger(columnsCount) && Number.isInteger(rowsCount)).toBe(true);
      expect(Math.abs(columnsCount - (each.kxRadpm * 60) / (2 * Math.PI))).toBeLessThanOrEqual(0.5);
      expect(Math.abs(rowsCount - (each.kzRadpm * 60) / (2 * Math.PI))).toBeLessThanOrEqual(0.5);
    }
  });
});

describe("ripples", () => {
  it("have a root mean square slope of 1 and lengths in their range", () => {
    const ripples = makeRipples(20, 0.2, 1, 40, 9.81);
    expect(slopeVariance(ripples)).toBeCloseTo(1, 9);
    for (const { kxRadpm, kzRadpm } of ripples) {
      const lengthM = (2 * Math.PI) / Math.hypot(kxRadpm, kzRadpm);
      expect(lengthM).toBeGreaterThan(0.19);
      expect(lengthM).toBeLessThan(1.01);
    }
  });

  it("become steeper with the storm", () => {
    const slopeAt = (levelRatio: number) => rippleSlope({ levelRatio, waveHeightM: 0.3 });
    expect(slopeAt(0)).toBe(rippleSlope(undefined));
    expect(slopeAt(1)).toBeGreaterThan(1.5 * slopeAt(0));
    expect(slopeAt(5)).toBe(slopeAt(1));
  });

  it("let crests foam more easily in wind, twice as much from half a storm on", () => {
    expect(tornByWind(rippleSlope({ levelRatio: 1, waveHeightM: 0 }))).toBe(1);
    expect(tornByWind(rippleSlope(undefined))).toBeLessThan(1.3);
    expect(tornByWind(rippleSlope({ levelRatio: 0.5, waveHeightM: 0.3 }))).toBe(2);
  });

  it("are hardly there in rain without wind", () => {
    const still = rippleSlope({ levelRatio: 1, waveHeightM: 0 });
    expect(still).toBeGreaterThan(0);
    expect(still).toBeLessThan(0.3 * rippleSlope(undefined));
  });
});

describe("the blend with the simulated water", () => {
  /** As simulatedShare() in sea_blend.glsl. */
  const shareAt = (info: Pick<WaveInfo, "sides" | "sideM" | "widthM" | "spongeWidthM">, xM: number, zM: number): number => {
    const { beyondM, widthM } = blendOf(info);
    const inside = [xM, -xM, zM, -zM].map((at) => info.sideM / 2 - at);
    return Math.min(...inside.map((insideM, n) => {
      const share = Math.min(Math.max((insideM + beyondM[n]!) / widthM[n]!, 0), 1);
      return share * share * (3 - 2 * share);
    }));
  };

  it("is complete at an open side and begins where its layer begins", () => {
    expect(shareAt(wave, 15, 3)).toBe(0);
    expect(shareAt(wave, 13, 3)).toBeGreaterThan(0);
    expect(shareAt(wave, 11, 3)).toBe(1);
    expect(kSideNames.length).toBe(4);
  });

  it("keeps the simulated water up to a closed side, and repeats it beyond a periodic one", () => {
    expect(shareAt({ ...wave, sides: sidesOf("closed", "open", "open", "open") }, 15, 0)).toBe(1);
    const periodic = { ...wave, sides: sidesOf("periodic", "periodic", "open", "open") };
    expect(shareAt(periodic, 15, 0)).toBe(1);
    expect(shareAt(periodic, 20, 0)).toBeGreaterThan(0);
    expect(shareAt(periodic, 24.1, 0)).toBe(0);
  });
});

describe("the water's grid", () => {
  it("reaches the horizon on open sides and ends at closed ones", () => {
    const lines = gridLines(72, true, false);
    expect(lines[0]!).toBeLessThan(-100);
    expect(lines.at(-1)).toBe(0.5);
    for (let n = 1; n < lines.length; ++n) expect(lines[n]!).toBeGreaterThan(lines[n - 1]!);
    expect(gridLines(8, false, false)).toEqual([-0.5, -0.375, -0.25, -0.125, 0, 0.125, 0.25, 0.375, 0.5]);
  });
});

describe("the coast", () => {
  const bed = { sideM: 32, widthM: 32, depthM: 1.2, beaches: [{ side: "+x" as const, widthM: 7, shoreDepthM: 0 }] };
  const coast = { bed, sides: sidesOf("closed", "open", "closed", "open") };

  it("has the bed's depth, rises behind a beach, stands as uneven rocks elsewhere", () => {
    expect(coastHeightM(coast, -60, -60)).toBeCloseTo(-1.2, 9);
    let before = coastHeightM(coast, 15.9, 0);
    for (let xM = 15.95; xM < 60; xM += 0.05) {
      const heightM = coastHeightM(coast, xM, 0);
      expect(Math.abs(heightM - before)).toBeLessThan(0.03);
      before = heightM;
    }
    expect(before).toBeGreaterThan(0.5);
    expect(coastHeightM(coast, 0, 15.99)).toBeLessThan(-1);
    const heightsM = [-12, -8, -4, 0, 4, 8].map((xM) => coastHeightM(coast, xM, 16.01));
    expect(Math.min(...heightsM)).toBeGreaterThan(0.3 * quayHeightM(bed));
    expect(Math.max(...heightsM) - Math.min(...heightsM)).toBeGreaterThan(0.3 * quayHeightM(bed));
  });

  it("stands as an even quay where the scene has no beach", () => {
    const harbor = { bed: { ...bed, beaches: [] }, sides: sidesOf("open", "open", "closed", "open") };
    for (const xM of [-12, -4, 0, 8]) expect(coastHeightM(harbor, xM, 16.01)).toBeCloseTo(quayHeightM(bed), 6);
  });

  it("continues outside the square: a shore comes forward, rocky land draws back, without a step", () => {
    expect(coastHeightM(coast, 14, -16.5)).toBeCloseTo(coastHeightM(coast, 14, 0), 1);
    expect(coastHeightM(coast, 14, -80)).toBeGreaterThan(coastHeightM(coast, 14, 0) + 0.5);
    expect(coastHeightM(coast, -14, 17)).toBeGreaterThan(0.2);
    expect(coastHeightM(coast, -80, 17)).toBeCloseTo(-1.2, 6);
    let before = coastHeightM(coast, 14, -16);
    for (let zM = -16; zM > -120; zM -= 0.1) {
      const heightM = coastHeightM(coast, 14, zM);
      expect(Math.abs(heightM - before)).toBeLessThan(0.05);
      before = heightM;
    }
  });

  it("is made of finite triangles, with land on the closed sides only", () => {
    const geometry = makeCoastGeometry(coast, 24, false);
    const position = geometry.getAttribute("position");
    const normal = geometry.getAttribute("normal");
    for (let n = 0; n < position.count; ++n) {
      for (const value of [position.getX(n), position.getY(n), position.getZ(n), normal.getX(n), normal.getY(n), normal.getZ(n)]) expect(Number.isFinite(value)).toBe(true);
      if (position.getX(n) < 8.9 && Math.abs(position.getZ(n)) < 15.3) expect(position.getY(n)).toBeLessThan(-1.1);
    }
    geometry.dispose();
  });

  it("leaves out the level bed in the plain tiers", () => {
    const levelCount = (plain: boolean): number => {
      const geometry = makeCoastGeometry(coast, 24, plain);
      const { position } = geometry.attributes;
      return Array.from(geometry.index!.array).filter((n) => position!.getY(n) <= -0.9999 * bed.depthM).length;
    };
    expect(levelCount(false)).toBeGreaterThan(1000);
    expect(levelCount(true)).toBeLessThan(0.2 * levelCount(false));
  });

  it("has houses and trees on the land, and pines on an island, never in the water", () => {
    // What stands on the ground is above it; a grid of the ground alone has nothing there.
    const highest = (coastWith: Parameters<typeof makeCoastGeometry>[0], isAt: (xM: number, zM: number) => boolean): number => {
      const { position } = makeCoastGeometry(coastWith, 24, true).attributes;
      let overM = 0;
      for (let n = 0; n < position!.count; ++n)
        if (isAt(position!.getX(n), position!.getZ(n))) overM = Math.max(overM, position!.getY(n) - coastHeightM(coastWith, position!.getX(n), position!.getZ(n)));
      return overM;
    };
    expect(highest(coast, (xM) => xM > 20 && xM < 40)).toBeGreaterThan(1);
    expect(highest(coast, (xM, zM) => xM < 14 && zM < 15)).toBeLessThan(0.01);
    const steep = { ...coast, bed: { ...bed, beaches: [{ side: "+x" as const, widthM: 12, shoreDepthM: -1.2 }] } };
    expect(highest(steep, (xM, zM) => xM < 15.9 && zM < 15)).toBeLessThan(0.01);
    const riseM = Float32Array.from({ length: 25 }, (_, n) => (n === 12 ? 1.2 : -1.2));
    const island = { bed: { ...bed, beaches: [], ground: { countX: 5, countZ: 5, lengthM: 32, widthM: 32, riseM } }, sides: sidesOf("open", "open", "open", "open") };
    expect(highest(island, (xM, zM) => Math.hypot(xM, zM) < 6)).toBeGreaterThan(1);
    expect(highest(island, (xM, zM) => Math.hypot(xM, zM) > 12)).toBeLessThan(0.01);
  });
});

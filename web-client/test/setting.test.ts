// Where a scene's water is, as the page reads it, and what is built around it.
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";

import { readFirstView, readSetting, readWaterType, readWind } from "../client/codec/scene_info";
import { Boundary, Dispersion, SceneSchema, Setting, WaterType, WaveBoundary } from "../client/gen/spindrift/v1/scene_pb";
import { waterOpticsOf } from "../src/scene/light/water_optics";
import { makeBaseGeometry, makeGlassGeometry, tankSize } from "../src/scene/solids/glass_tank";
import { makeBasinGeometries } from "../src/scene/solids/pool_basin";

const wall = { boundaryMinusX: WaveBoundary.REFLECT, boundaryPlusX: WaveBoundary.REFLECT, boundaryMinusZ: WaveBoundary.REFLECT, boundaryPlusZ: WaveBoundary.REFLECT };
const sized = { sideM: 16, depthM: 1.5, resolutionCount: 192 };

describe("the setting", () => {
  it("is the one that the server names", () => {
    for (const [setting, name] of [[Setting.POOL, "pool"], [Setting.GLASS_TANK, "glassTank"], [Setting.FLUME, "flume"], [Setting.OPEN_SEA, "openSea"]] as const)
      expect(readSetting(create(SceneSchema, { wave: sized, setting }))).toBe(name);
  });

  it("follows from the sides if the server names no known one", () => {
    for (const setting of [Setting.UNSPECIFIED, 99 as Setting]) {
      expect(readSetting(create(SceneSchema, { wave: sized, setting }))).toBe("openSea");
      expect(readSetting(create(SceneSchema, { wave: { ...sized, ...wall }, setting }))).toBe("pool");
      expect(readSetting(create(SceneSchema, { particles: { boxSideM: 4, boundaryX: Boundary.WALL }, setting }))).toBe("glassTank");
    }
  });

  it("is not an open sea without a wave", () => {
    expect(readSetting(create(SceneSchema, { particles: {}, setting: Setting.OPEN_SEA }))).toBe("glassTank");
  });
});

describe("the water", () => {
  it("is of the type that the server names, or one that suits the setting", () => {
    expect(readWaterType(create(SceneSchema, { wave: sized, waterType: WaterType.LAGOON }))).toBe("lagoon");
    expect(readWaterType(create(SceneSchema, { wave: sized, waterType: 99 as WaterType }))).toBe("coast");
    expect(readWaterType(create(SceneSchema, { particles: {} }))).toBe("pool");
  });

  it("sends up blue light in the ocean, green light in a harbor, and never more than comes in", () => {
    const [ocean, harbor] = [waterOpticsOf("ocean"), waterOpticsOf("harbor")];
    expect(ocean.scattered[2]).toBeGreaterThan(1.5 * ocean.scattered[1]);
    expect(harbor.scattered[1]).toBeGreaterThan(harbor.scattered[2]);
    for (const type of ["pool", "lagoon", "ocean", "coast", "harbor"] as const) {
      const { lossPerM, scattered, bubbly } = waterOpticsOf(type);
      expect(lossPerM[0]).toBeGreaterThan(lossPerM[1]);
      for (const i of [0, 1, 2] as const) {
        expect(bubbly[i]).toBeGreaterThan(scattered[i]);
        expect(bubbly[i]).toBeLessThan(0.6);
      }
    }
  });
});

describe("the first view", () => {
  it("is that of the scene in radians, with the defaults of the server's rules", () => {
    expect(readFirstView(create(SceneSchema, { wave: sized }))).toBeUndefined();
    expect(readFirstView(create(SceneSchema, { firstView: { xM: 2, headingDeg: 180, hour: 16 } }))).toEqual({ xM: 2, zM: 0, acrossM: 0, awayM: 0, headingRad: Math.PI, pitchRad: (22 * Math.PI) / 180, hour: 16, subjectRightM: 0 });
  });

  it("is left out where its numbers cannot be drawn", () => {
    for (const firstView of [{ xM: NaN }, { acrossM: -1 }, { pitchDeg: 90 }, { hour: 25 }]) expect(readFirstView(create(SceneSchema, { firstView }))).toBeUndefined();
  });
});

describe("the wind of a scene", () => {
  const storm = { levelRatio: 0.3, waveHeightM: 0.35, windDirectionDeg: 40, windSpeedMps: 15, fetchM: 2000 };
  const open = { ...sized, dispersion: Dispersion.AIRY, boundaryMinusX: WaveBoundary.ABSORB, boundaryPlusX: WaveBoundary.ABSORB };

  it("comes in as a sea through an open side of water with dispersion only", () => {
    expect(readWind(create(SceneSchema, { wave: open, storm, gravityMps2: 9.81, seed: 3n }))).toMatchObject({ comesIn: true, seed: 3n, levelRatio: 0.3, directionDeg: 40 });
    expect(readWind(create(SceneSchema, { wave: { ...open, dispersion: Dispersion.NONE }, storm, gravityMps2: 9.81 }))).toMatchObject({ comesIn: false });
  });

  it("is absent without a storm, or with numbers that cannot be drawn", () => {
    expect(readWind(create(SceneSchema, { wave: open, gravityMps2: 9.81 }))).toBeUndefined();
    expect(readWind(create(SceneSchema, { wave: open, storm: { ...storm, fetchM: NaN }, gravityMps2: 9.81 }))).toBeUndefined();
  });
});

function boundsOf(geometry: ReturnType<typeof makeGlassGeometry>) {
  geometry.computeBoundingBox();
  return geometry.boundingBox!;
}

describe("a tank", () => {
  const greeting = { sideM: 4, widthM: 0.8, waterExtents: { sideM: 0.8, longM: 0.8, depthM: 2 }, wave: undefined };

  it("encloses the water with room above it, and the glass lies outside the water", () => {
    const size = tankSize(greeting);
    expect(size.heightM).toBeGreaterThan(2.1);
    const { min, max } = boundsOf(makeGlassGeometry(size));
    expect(max.x).toBeGreaterThan(2);
    expect(max.z).toBeGreaterThan(0.4);
    expect(min.y).toBe(0);
    expect(max.y).toBeCloseTo(size.heightM, 6);
  });

  it("stands on a plate below its floor", () => {
    const { min, max } = boundsOf(makeBaseGeometry(tankSize(greeting)));
    expect(min.y).toBeLessThan(0);
    expect(max.y).toBeLessThan(0);
    expect(max.x).toBeGreaterThan(2);
  });
});

describe("a tray", () => {
  it("stands on a table, with its walls over the water", () => {
    const { min, max } = boundsOf(makeBaseGeometry(tankSize({ sideM: 0.45, widthM: 0.45, waterExtents: { sideM: 0.45, longM: 0.45, depthM: 0.05 }, wave: undefined })));
    expect(min.y).toBeLessThan(-0.7);
    expect(max.y).toBeGreaterThan(0.05);
    expect(max.x).toBeGreaterThan(0.4);
  });
});

describe("the walls of a tank", () => {
  it("stand over the resting water, and leave the upper part of the glass free", () => {
    for (const [sideM, widthM, depthM] of [[0.45, 0.45, 0.05], [6, 4, 1.5]] as const) {
      const { wallM, heightM } = tankSize({ sideM, widthM, waterExtents: { sideM, longM: sideM, depthM }, wave: undefined });
      expect(wallM).toBeGreaterThan(depthM);
      expect(wallM).toBeLessThan(0.5 * (depthM + heightM));
    }
  });

  it("of a channel of particles are half as high as the glass, and lower in a short one: a tall tank is of glass", () => {
    const channel = (sideM: number, depthM: number) => tankSize({ sideM, widthM: 0.8, waterExtents: { sideM, longM: sideM, depthM }, wave: undefined });
    const long = channel(9, 1);
    expect(long.wallM).toBeCloseTo(long.heightM / 2, 9);
    expect(channel(4, 2).wallM).toBeCloseTo(0.16 * 4, 9);
  });
});

describe("a pool", () => {
  it("has its floor at 0, a rim above the water, and nothing inside the square above the floor", () => {
    const { tiled, planted } = makeBasinGeometries(16, 16, 1.5);
    expect(boundsOf(tiled).min.y).toBe(0);
    expect(boundsOf(tiled).max.y).toBeGreaterThan(1.5);
    expect(boundsOf(planted).max.x).toBeGreaterThan(300);
    const position = tiled.getAttribute("position");
    for (let n = 0; n < position.count; ++n)
      if (Math.abs(position.getX(n)) < 7.8 && Math.abs(position.getZ(n)) < 7.8) expect(position.getY(n)).toBe(0);
  });

  it("has a garden that leaves the water free but for ladders, with less of it in the plain tiers", () => {
    const verticesCount = [false, true].map((plain) => {
      const { planted } = makeBasinGeometries(16, 16, 1.5, plain);
      const position = planted.getAttribute("position");
      for (let n = 0; n < position.count; ++n) expect(Math.max(Math.abs(position.getX(n)), Math.abs(position.getZ(n)))).toBeGreaterThan(7.7);
      return position.count;
    });
    expect(verticesCount[1]).toBeLessThan(0.5 * verticesCount[0]!);
    const large = makeBasinGeometries(1000, 1000, 1.5).planted.getAttribute("position").count;
    expect(large).toBeLessThan(4 * verticesCount[0]!);
  });
});

// The volume that particles are drawn from: where it lies, and how its slices lie in a texture.
import { describe, expect, it } from "vitest";

import { kMostCellsCount, volumeShape } from "../src/scene/fluid/volume_shape";

const kTank = { sideM: 4, widthM: 0.8, floorM: -1 };

describe("the volume of a tank", () => {
  it("has the sides and the floor of the tank, and the height of its water", () => {
    const { minM, maxM, cellsCount, cellM } = volumeShape([-2, -0.95, -0.35], [-1, 1, 0.35], 0.2, 0.05, kTank);
    expect(minM).toEqual([-2, -1, -0.4]);
    expect(maxM).toEqual([2, 1.2, 0.4]);
    expect(cellM).toBe(0.05);
    expect(cellsCount).toEqual([80, 44, 16]);
  });
});

describe("the volume in a wave", () => {
  it("reaches as far as the kernels and keeps its cells in place", () => {
    for (const shiftM of [0, 0.013, 0.02, 3.7]) {
      const { minM, maxM, cellM } = volumeShape([-1 + shiftM, 0, -1], [1 + shiftM, 2, 1], 0.3, 0.1, undefined);
      expect(minM[0]).toBeLessThanOrEqual(-1.3 + shiftM);
      expect(maxM[0]).toBeCloseTo(1.3 + shiftM);
      for (const at of minM) expect(Math.abs(at / cellM - Math.round(at / cellM))).toBeLessThan(1e-6);
    }
  });

  it("is never empty", () => {
    const { cellsCount } = volumeShape([0, 0, 0], [0, 0, 0], 0, 0.1, undefined);
    expect(Math.min(...cellsCount)).toBeGreaterThanOrEqual(2);
  });
});

describe("the slices", () => {
  it.each([1, 10, 100, 1000])("of a volume of %s m fit a texture of any WebGL 2, with cells as fine as the limit lets them be", (sizeM) => {
    for (const high of [0.1, 1, 10]) {
      const shape = volumeShape([0, 0, 0], [sizeM, high * sizeM, sizeM], 0.1, 0.05, undefined);
      const [x, y, z] = shape.cellsCount;
      expect(x * y * z).toBeLessThan(1.3 * kMostCellsCount);
      expect(Math.max(shape.widthPx, shape.heightPx)).toBeLessThanOrEqual(2048);
      expect(shape.slicesPerRow * Math.floor(shape.heightPx / z)).toBeGreaterThanOrEqual(y);
      expect(shape.widthPx).toBe(shape.slicesPerRow * x);
    }
  });
});

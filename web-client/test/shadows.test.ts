// The frame of the map of shadows: what it covers, and how it turns with the light.
import { Vector3 } from "three";
import { describe, expect, it } from "vitest";

import { lightAt } from "../src/scene/light/light";
import { shadowMatrix, toClip, type ShadowBox } from "../src/scene/shadows/shadow_frame";

const kBox: ShadowBox = { halfM: 20, lowM: -1.2, highM: 5 };
const corners = [-1, 1].flatMap((x) => [kBox.lowM, kBox.highM].flatMap((y) => [-1, 1].map((z) => new Vector3(x * kBox.halfM, y, z * kBox.halfM))));
const lights = [0, 6.5, 9, 12, 15, 17.7, 18.3, 21].map((hour) => new Vector3(...lightAt(hour, 0).keyDirection));

describe("the map of shadows", () => {
  it("holds its box from noon to midnight, and no more than that", () => {
    for (const light of lights) {
      const seen = corners.map((corner) => corner.clone().applyMatrix4(shadowMatrix(kBox, light)));
      for (const axis of ["x", "y", "z"] as const) {
        expect(Math.min(...seen.map((at) => at[axis]))).toBeCloseTo(0, 9);
        expect(Math.max(...seen.map((at) => at[axis]))).toBeCloseTo(1, 9);
      }
    }
  });

  it("has a thing and its shadow in one place, the thing nearer to the light", () => {
    for (const light of lights) {
      const top = new Vector3(3, 2, -4);
      const shadow = top.clone().addScaledVector(light, -top.y / light.y);
      const [a, b] = [top, shadow].map((at) => at.clone().applyMatrix4(shadowMatrix(kBox, light)));
      expect(a!.x).toBeCloseTo(b!.x, 9);
      expect(a!.y).toBeCloseTo(b!.y, 9);
      expect(a!.z).toBeLessThan(b!.z);
    }
  });

  it("keeps places where they are while the light stays, also straight from above", () => {
    const above = shadowMatrix(kBox, new Vector3(0, 1, 0));
    for (const corner of corners) expect(Number.isFinite(corner.clone().applyMatrix4(above).lengthSq())).toBe(true);
    const middle = new Vector3(0, (kBox.lowM + kBox.highM) / 2, 0).applyMatrix4(above);
    for (const axis of ["x", "y", "z"] as const) expect(middle[axis]).toBeCloseTo(0.5, 9);
  });

  it("is drawn with the same places, from -1 to 1", () => {
    const matrix = shadowMatrix(kBox, lights[3]!);
    for (const corner of corners) {
      const at = corner.clone().applyMatrix4(matrix);
      const drawn = corner.clone().applyMatrix4(toClip(matrix));
      for (const axis of ["x", "y", "z"] as const) expect(drawn[axis]).toBeCloseTo(2 * at[axis] - 1, 9);
    }
  });
});

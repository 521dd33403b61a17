import { PerspectiveCamera, Vector3, Vector4 } from "three";
import { describe, expect, it } from "vitest";

import { viewRay } from "../src/scene/fluid/view_ray";

describe("a view ray", () => {
  it("leads to the point that was projected, also where the picture is centred beside the canvas's middle", () => {
    for (const [widthPx, heightPx, leftPx, topPx] of [[1280, 720, 0, 0], [900, 600, 160, -55], [390, 844, -20, 210]] as const) {
      const camera = new PerspectiveCamera(47, widthPx / heightPx, 0.1, 1000);
      camera.setViewOffset(widthPx, heightPx, leftPx, topPx, widthPx, heightPx);
      const ray = viewRay(camera, new Vector4());
      for (const point of [new Vector3(0, 0, -3), new Vector3(1.2, -0.7, -4), new Vector3(-30, 8, -90)]) {
        const seen = point.clone().applyMatrix4(camera.projectionMatrix);
        const found = new Vector3(seen.x * ray.x + ray.z, seen.y * ray.y + ray.w, -1).multiplyScalar(-point.z);
        expect(found.distanceTo(point)).toBeLessThan(1e-4 * point.length());
      }
    }
  });
});

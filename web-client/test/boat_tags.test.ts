import { Matrix4, PerspectiveCamera } from "three";
import { describe, expect, it } from "vitest";

import { tagsApart } from "../src/ui/boat_tags";
import { tagPlace } from "../src/ui/tag_place";

function seenFrom(zM: number): Matrix4 {
  const camera = new PerspectiveCamera(60, 390 / 844, 0.1, 100);
  camera.position.set(0, 0, zM);
  camera.updateMatrixWorld();
  return new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
}

describe("a boat's name tag", () => {
  const seen = seenFrom(10);

  it("is where the point is on the page", () => {
    expect(tagPlace(seen, [0, 0, 0], 390, 844, [])).toEqual({ xPx: 195, yPx: 422, awayM: 10 });
    const right = tagPlace(seen, [1, 2, 0], 390, 844, [])!;
    expect(right.xPx).toBeGreaterThan(195);
    expect(right.yPx).toBeCloseTo(422 - (2 / 10 / Math.tan(Math.PI / 6)) * 422, 3);
  });

  it("is hidden outside the view and without a finite position", () => {
    for (const point of [[0, 0, 11], [0, 0, 10], [50, 0, 0], [0, 50, 0], [0, -50, 0], [Number.NaN, 0, 0]] as const) expect(tagPlace(seen, point, 390, 844, [])).toBeUndefined();
  });

  it("is hidden under a panel, also where only its edge is", () => {
    const panel = { leftPx: 0, topPx: 430, rightPx: 390, bottomPx: 844 };
    expect(tagPlace(seen, [0, 0, 0], 390, 844, [panel])).toBeDefined();
    expect(tagPlace(seen, [0, -1, 0], 390, 844, [panel])).toBeUndefined();
    const card = { leftPx: 0, topPx: 0, rightPx: 170, bottomPx: 844 };
    expect(tagPlace(seen, [0, 0, 0], 390, 844, [card])).toBeUndefined();
    expect(tagPlace(seen, [1, 0, 0], 390, 844, [card])).toBeDefined();
  });

  it("is shown for the nearest boats only, and for the first of a race before them", () => {
    const tags = [5, 1, 4, 2, 3].map((awayM) => ({ place: { xPx: 100 * awayM, yPx: 0, awayM }, rank: undefined as number | undefined }));
    expect(tagsApart(tags, 3).map(({ place }) => place.awayM)).toEqual([1, 2, 3]);
    tags[0]!.rank = 2;
    tags[2]!.rank = 1;
    expect(tagsApart(tags, 3).map(({ place }) => place.awayM)).toEqual([4, 5, 1]);
  });

  it("is not shown over another one", () => {
    const at = (xPx: number, yPx: number, awayM: number): { place: { xPx: number; yPx: number; awayM: number }; rank: undefined } => ({ place: { xPx, yPx, awayM }, rank: undefined });
    expect(tagsApart([at(0, 0, 2), at(40, 10, 1), at(40, 60, 3), at(200, 10, 4)], 8).map(({ place }) => place.awayM)).toEqual([1, 3, 4]);
  });
});

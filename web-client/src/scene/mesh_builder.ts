// Collects coloured triangles of procedural solids: position, normal and colour. The fourth number of a colour is the grain of the
// material (0 paint, 1 stone).
import { BufferAttribute, BufferGeometry } from "three";

export type Point = readonly [number, number, number];
export type Paint = readonly [red: number, green: number, blue: number, grain: number];

export class MeshBuilder {
  private readonly positions: number[] = [];
  private readonly colors: number[] = [];
  private readonly index: number[] = [];

  /**
   * Adds a grid of points, smooth inside and sharp at its edges. Seen from outside, rows go up and columns go right. `keeps`: leaves out
   * the cells for whose corners it returns false.
   */
  grid(rows: readonly (readonly Point[])[], paint: Paint | ((row: number, column: number) => Paint), keeps?: (corners: readonly Point[]) => boolean): this {
    const first = this.positions.length / 3;
    const columnsCount = rows[0]!.length;
    rows.forEach((row, r) =>
      row.forEach((point, c) => {
        this.positions.push(...point);
        this.colors.push(...(typeof paint === "function" ? paint(r, c) : paint));
      }),
    );
    for (let r = 0; r + 1 < rows.length; ++r)
      for (let c = 0; c + 1 < columnsCount; ++c) {
        if (keeps && !keeps([rows[r]![c]!, rows[r]![c + 1]!, rows[r + 1]![c]!, rows[r + 1]![c + 1]!])) continue;
        const low = first + r * columnsCount + c;
        const high = low + columnsCount;
        this.index.push(low, low + 1, high, high, low + 1, high + 1);
      }
    return this;
  }

  /** Adds a flat face; corners counter-clockwise seen from outside. */
  quad(a: Point, b: Point, c: Point, d: Point, paint: Paint): this {
    return this.grid([[a, b], [d, c]], paint);
  }

  /** Adds an upright block round (x, z) between two heights; top and bottom have half sizes along x and z. */
  block(xM: number, zM: number, low: { yM: number; halfX: number; halfZ: number }, high: { yM: number; halfX: number; halfZ: number }, paint: Paint, topPaint = paint): this {
    const corner = (level: typeof low, sx: number, sz: number): Point => [xM + sx * level.halfX, level.yM, zM + sz * level.halfZ];
    for (const [ax, az, bx, bz] of [[-1, 1, 1, 1], [1, 1, 1, -1], [1, -1, -1, -1], [-1, -1, -1, 1]] as const)
      this.quad(corner(low, ax, az), corner(low, bx, bz), corner(high, bx, bz), corner(high, ax, az), paint);
    return this.quad(corner(high, -1, 1), corner(high, 1, 1), corner(high, 1, -1), corner(high, -1, -1), topPaint);
  }

  /** `flat`: one normal per triangle, for broken stone. */
  build(flat = false): BufferGeometry {
    const indexed = new BufferGeometry();
    indexed.setAttribute("position", new BufferAttribute(new Float32Array(this.positions), 3));
    indexed.setAttribute("color", new BufferAttribute(new Float32Array(this.colors), 4));
    indexed.setIndex(this.index);
    const geometry = flat ? indexed.toNonIndexed() : indexed;
    geometry.computeVertexNormals();
    if (flat) indexed.dispose();
    return geometry;
  }
}

// Collects coloured triangles of procedural solids: position, normal and colour. The fourth number of a colour is the grain of the
// material (0 paint, 1 stone; -1: a lamp, which shines by itself in the dark).
import { BufferAttribute, BufferGeometry } from "three";

export type Point = readonly [number, number, number];
export type Paint = readonly [red: number, green: number, blue: number, grain: number];

/** Rows `from` to `to` of a grid in one paint. `isSharp`: with an edge toward the band below. */
export interface Band {
  from: number;
  to: number;
  paint: Paint | ((row: number, column: number) => Paint);
  isSharp?: boolean;
}

export class MeshBuilder {
  private readonly positions: number[] = [];
  private readonly colors: number[] = [];
  private readonly index: number[] = [];
  /** Vertices at one position that share a normal. */
  private readonly welds: [number, number][] = [];
  /** First of the four vertices of each leaf, and its normal, which does not follow from its triangles. */
  private readonly leaves: { first: number; normal: Point }[] = [];

  /**
   * Adds a grid of points, smooth inside and sharp at its edges. Seen from outside, rows go up and columns go right. `keeps`: leaves out
   * the cells for whose corners it returns false.
   */
  grid(rows: readonly (readonly Point[])[], paint: Paint | ((row: number, column: number) => Paint), keeps?: (corners: readonly Point[]) => boolean): this {
    const first = this.positions.length / 3;
    const columnsCount = rows[0]!.length;
    rows.forEach((row, r) =>
      row.forEach((point, c) => {
        const [red, green, blue, grain] = typeof paint === "function" ? paint(r, c) : paint;
        this.positions.push(point[0], point[1], point[2]);
        this.colors.push(red, green, blue, grain);
      }),
    );
    for (let r = 0; r + 1 < rows.length; ++r)
      for (let c = 0; c + 1 < columnsCount; ++c) {
        if (keeps && !keeps([rows[r]![c]!, rows[r]![c + 1]!, rows[r + 1]![c]!, rows[r + 1]![c + 1]!])) continue;
        const low = first + r * columnsCount + c;
        const high = low + columnsCount;
        this.triangle(low, low + 1, high);
        this.triangle(high, low + 1, high + 1);
      }
    return this;
  }

  /** Adds a grid in bands of several paints, smooth across their borders unless a band is sharp. */
  bands(rows: readonly (readonly Point[])[], bands: readonly Band[]): this {
    const columnsCount = rows[0]!.length;
    bands.forEach(({ from, to, paint, isSharp }, n) => {
      const first = this.positions.length / 3;
      if (n > 0 && !isSharp) for (let c = 0; c < columnsCount; ++c) this.welds.push([first - columnsCount + c, first + c]);
      this.grid(rows.slice(from, to + 1), paint);
    });
    return this;
  }

  /** Adds a band round an axis, smooth round it: each row's last point is its first one. */
  ring(rows: readonly (readonly Point[])[], paint: Paint): this {
    const first = this.positions.length / 3;
    const columnsCount = rows[0]!.length;
    rows.forEach((_, r) => this.welds.push([first + r * columnsCount, first + (r + 1) * columnsCount - 1]));
    return this.grid(rows, paint);
  }

  /** Adds a flat face; corners counter-clockwise seen from outside. */
  quad(a: Point, b: Point, c: Point, d: Point, paint: Paint): this {
    return this.grid([[a, b], [d, c]], paint);
  }

  /** Adds a face that is seen from both sides and lit as if it faced `normal`, of length 1; not in a flat mesh. */
  leaf(a: Point, b: Point, c: Point, d: Point, normal: Point, paint: Paint): this {
    const first = this.positions.length / 3;
    this.leaves.push({ first, normal });
    this.quad(a, b, c, d, paint);
    this.triangle(first + 1, first, first + 2);
    this.triangle(first + 1, first + 2, first + 3);
    return this;
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
    else this.weld(geometry.getAttribute("normal") as BufferAttribute);
    return geometry;
  }

  /** Leaves out triangles without an area, which have no normal. */
  private triangle(a: number, b: number, c: number): void {
    if (!this.isSame(a, b) && !this.isSame(b, c) && !this.isSame(c, a)) this.index.push(a, b, c);
  }

  private isSame(a: number, b: number): boolean {
    const { positions } = this;
    return positions[3 * a] === positions[3 * b] && positions[3 * a + 1] === positions[3 * b + 1] && positions[3 * a + 2] === positions[3 * b + 2];
  }

  private weld(normals: BufferAttribute): void {
    for (const [a, b] of this.welds) {
      const [x, y, z] = [normals.getX(a) + normals.getX(b), normals.getY(a) + normals.getY(b), normals.getZ(a) + normals.getZ(b)];
      const length = Math.hypot(x, y, z);
      if (length === 0) continue;
      for (const vertex of [a, b]) normals.setXYZ(vertex, x / length, y / length, z / length);
    }
    for (const { first, normal } of this.leaves) for (let n = 0; n < 4; ++n) normals.setXYZ(first + n, ...normal);
    // A vertex of left out triangles only.
    for (let n = 0; n < normals.count; ++n) if (normals.getX(n) === 0 && normals.getY(n) === 0 && normals.getZ(n) === 0) normals.setY(n, 1);
  }
}

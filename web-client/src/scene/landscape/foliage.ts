// Plants of leaves: shrubs, trees, cypresses. A clump is a lumpy core with flat leaves around it, turned at random.
import { mix } from "../maths/interpolate";
import { makeFastRandom } from "../maths/random";
import { MeshBuilder, type Paint, type Point } from "../meshes/mesh_builder";
import { addRod } from "../meshes/shapes";

/** Colours of the leaves, of which each takes a mixture. */
export type Leaves = readonly [Paint, Paint];

const kBark: Paint = [0.19, 0.14, 0.10, 1];
/** The lumpy core of a clump: its size relative to the clump, its brightness relative to the leaves, and its rows and columns. */
const kCoreSizes = [0.7, 1.0] as const;
const kCoreBright = 0.62;
const kCoreCells = { full: [5, 9], plain: [3, 6] } as const;
const kGoldenAngleRad = 2.39996323;

export class Foliage {
  private readonly random = makeFastRandom(4242);

  /** Adds leaves to a mesh of their own, which casts no shadow: that of the cores is enough. */
  leaves = new MeshBuilder();

  /** `plain`: cores alone, and fewer of them. */
  constructor(private readonly builder: MeshBuilder, readonly plain: boolean) {}

  /** Returns a number of the range, other ones with each call. */
  between(low: number, high: number): number {
    return mix(low, high, this.random());
  }

  /** Adds a clump of `count` leaves of half length `leafM` on a lumpy ellipsoid. */
  clump(middle: Point, half: Point, count: number, leafM: number, leaves: Leaves): void {
    const { builder, plain } = this;
    const [rowsCount, columnsCount] = kCoreCells[plain ? "plain" : "full"];
    const rows = Array.from({ length: rowsCount + 1 }, (_, r) => {
      const up = -Math.cos((Math.PI * r) / rowsCount);
      const at = (round: number): Point => this.onClump(middle, half, up, round, this.between(...kCoreSizes));
      const row = Array.from({ length: columnsCount }, (_unused, c) => at((-2 * Math.PI * c) / columnsCount));
      return [...row, row[0]!];
    });
    const green: Leaves = [leaves[0], leaves[0]];
    builder.grid(rows, (row) => this.paint(green, kCoreBright * (0.8 - 0.5 * Math.cos((Math.PI * row) / rowsCount))));
    for (let i = 0; i < (plain ? 0 : count); ++i) {
      const up = 1 - (1.7 * (i + 0.5)) / count;
      const at = this.onClump(middle, half, up, kGoldenAngleRad * i + this.between(-0.5, 0.5), this.between(0.84, 1.08));
      this.leaf(at, middle, leafM * this.between(0.7, 1.3), this.paint(leaves, 0.8 + 0.5 * up));
    }
  }

  /** Adds a tree with a round crown. */
  tree([xM, yM, zM]: Point, highM: number, leaves: Leaves): void {
    const crownM = 0.27 * highM;
    const leanM = this.between(-0.05, 0.05) * highM;
    addRod(this.builder, [xM, yM - 0.2, zM], [xM + leanM, yM + 0.6 * highM, zM], 0.028 * highM, kBark, 6, 0.014 * highM);
    const clumpsCount = this.plain ? 3 : 6;
    for (let i = 0; i < clumpsCount; ++i) {
      const round = (2 * Math.PI * (i + this.between(-0.3, 0.3))) / (clumpsCount - 1);
      const outM = i === 0 ? 0 : this.between(0.55, 0.8) * crownM;
      const sizeM = (i === 0 ? 0.85 : this.between(0.55, 0.8)) * crownM;
      const upM = i === 0 ? 0.8 * highM : this.between(0.5, 0.75) * highM;
      const middle: Point = [xM + leanM + outM * Math.cos(round), yM + upM, zM + outM * Math.sin(round)];
      this.clump(middle, [sizeM, 0.85 * sizeM, sizeM], 30, 0.03 * highM, leaves);
    }
  }

  /** Adds a tall slender tree. */
  cypress([xM, yM, zM]: Point, highM: number, leaves: Leaves): void {
    this.clump([xM, yM + 0.48 * highM, zM], [0.11 * highM, 0.53 * highM, 0.11 * highM], 60, 0.03 * highM, leaves);
  }

  private onClump(middle: Point, half: Point, up: number, roundRad: number, size: number): Point {
    const level = Math.sqrt(Math.max(1 - up * up, 0));
    const outward = [level * Math.cos(roundRad), up, level * Math.sin(roundRad)];
    return outward.map((each, k) => middle[k]! + size * half[k]! * each) as unknown as Point;
  }

  private paint([first, second]: Leaves, bright: number): Paint {
    const share = this.random();
    const by = bright * this.between(0.72, 1.28);
    return first.map((each, k) => (k < 3 ? by : 1) * mix(each, second[k]!, share)) as unknown as Paint;
  }

  private leaf(at: Point, middle: Point, halfM: number, paint: Paint): void {
    const awayM = Math.hypot(at[0] - middle[0], at[1] - middle[1], at[2] - middle[2]) || 1;
    const [nx, ny, nz] = at.map((each, k) => (each - middle[k]!) / awayM + this.between(-0.6, 0.6) + (k === 1 ? 0.25 : 0)) as [number, number, number];
    // Two directions across the normal, turned about it at random.
    const norm = Math.hypot(nx, ny, nz) || 1;
    const flat = Math.hypot(nx, nz) || 1;
    const side: Point = [nz / flat, 0, -nx / flat];
    const other: Point = [(ny * side[2]) / norm, (nz * side[0] - nx * side[2]) / norm, (-ny * side[0]) / norm];
    const turn = this.between(0, 2 * Math.PI);
    const [c, s] = [Math.cos(turn), Math.sin(turn)];
    const along = (k: number, long: number, wide: number): number => long * (c * side[k]! + s * other[k]!) + wide * (c * other[k]! - s * side[k]!);
    const corner = (long: number, wide: number): Point => [0, 1, 2].map((k) => at[k]! + halfM * along(k, long, wide)) as unknown as Point;
    this.leaves.quad(corner(1, 0), corner(-0.7, 0.7), corner(-0.7, -0.7), corner(-0.7, -0.7), paint);
  }
}

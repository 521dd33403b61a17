// Plants of leaves: shrubs, trees, cypresses, pines. A clump is a lumpy ellipsoid, dark in its hollows.
import { clamp, mix } from "../maths/interpolate";
import { makeFastRandom } from "../maths/random";
import type { MeshBuilder, Paint, Point } from "../meshes/mesh_builder";
import { addRod } from "../meshes/shapes";

/** Colours of the leaves, of which each takes a mixture. */
export type Leaves = readonly [Paint, Paint];

const kBark: Paint = [0.19, 0.14, 0.10, 1];
/** A clump in its hollows and on its lumps: size relative to the ellipsoid, and brightness relative to the leaves. */
const kSizes = [0.72, 1.0] as const;
const kBrightness = [0.3, 1.0] as const;
/** Its rows, its columns, and how uneven its lumps are: in a garden, on the land behind a sea, and in the plain tiers. */
const kCells = { garden: [8, 14, 0.15], land: [6, 10, 0.35], plain: [4, 7, 0.15] } as const;
/** Sprigs of a clump, which tear its outline, and of one far away. */
const kSprigsCount = 48;
export const kFarSprigsCount = 28;
/** Where they begin and end, and half of their widths there, relative to the ellipsoid. */
const kSprigFoot = 0.7;
const kSprigReach = [1.0, 1.2] as const;
const kSprigHalfWidths = [0.26, 0.12] as const;

export class Foliage {
  private readonly random = makeFastRandom(4242);
  private readonly sprigs = makeFastRandom(99);

  constructor(readonly builder: MeshBuilder, private readonly cells: keyof typeof kCells) {}

  get plain(): boolean {
    return this.cells === "plain";
  }

  /** Returns a number of the range, other ones with each call. */
  between(low: number, high: number): number {
    return mix(low, high, this.random());
  }

  /** Adds a clump within an ellipsoid, out of which sprigs stick. */
  clump(middle: Point, half: Point, leaves: Leaves, sprigsCount = kSprigsCount): void {
    const [rowsCount, columnsCount, uneven] = kCells[this.cells];
    const phase = [0, 1, 2, 3].map(() => this.between(0, 2 * Math.PI));
    // 0 in a hollow, 1 on a lump; the last column is the first one again.
    const lumps = Array.from({ length: rowsCount + 1 }, (_, r) => {
      const row = Array.from({ length: columnsCount }, (_unused, c) => {
        const [up, round] = [(Math.PI * r) / rowsCount, (2 * Math.PI * c) / columnsCount];
        const wide = Math.sin(3 * round + phase[0]! + 2 * Math.sin(2 * up + phase[1]!)) * Math.sin(4 * up + phase[2]! + Math.sin(round + phase[3]!));
        return clamp(0.5 + 0.3 * wide + this.between(-uneven, uneven), 0, 1);
      });
      return [...row, row[0]!];
    });
    const rows = lumps.map((row, r) => row.map((lump, c) => onEllipsoid(middle, half, (Math.PI * r) / rowsCount, (-2 * Math.PI * c) / columnsCount, mix(...kSizes, lump))));
    this.builder.grid(rows, (r, c) => this.paint(leaves, mix(...kBrightness, lumps[r]![c]!) * (0.8 - 0.4 * Math.cos((Math.PI * r) / rowsCount))));
    if (!this.plain) for (let n = 0; n < sprigsCount; ++n) this.sprig(middle, half, leaves);
  }

  /** Adds a sprig that sticks out of an ellipsoid and is lit as the ellipsoid is there. */
  private sprig(middle: Point, half: Point, leaves: Leaves): void {
    const random = this.sprigs;
    const [upRad, roundRad, turnRad] = [Math.acos(mix(-0.9, 0.6, random())), 2 * Math.PI * random(), 2 * Math.PI * random()];
    const unit = (up: number): Point => onEllipsoid([0, 0, 0], [1, 1, 1], up, roundRad, 1);
    const [out, up] = [unit(upRad), unit(upRad + Math.PI / 2)];
    const around: Point = [-Math.sin(roundRad), 0, Math.cos(roundRad)];
    const corner = (size: number, wide: number): Point => out.map((each, k) => middle[k]! + half[k]! * (size * each + wide * (Math.cos(turnRad) * up[k]! + Math.sin(turnRad) * around[k]!))) as unknown as Point;
    const tip = mix(...kSprigReach, random());
    const paint = this.paint(leaves, 0.8 - 0.4 * Math.cos(upRad), random);
    const [wide, narrow] = kSprigHalfWidths;
    this.builder.leaf(corner(kSprigFoot, -wide), corner(kSprigFoot, wide), corner(tip, narrow), corner(tip, -narrow), out, paint);
  }

  /** Adds a crown of clumps. */
  crown([xM, yM, zM]: Point, radiusM: number, leaves: Leaves, sprigsCount = kSprigsCount): void {
    const clumpsCount = this.plain ? 3 : 6;
    for (let i = 0; i < clumpsCount; ++i) {
      const round = (2 * Math.PI * (i + this.between(-0.3, 0.3))) / (clumpsCount - 1);
      const outM = i === 0 ? 0 : this.between(0.55, 0.8) * radiusM;
      const sizeM = (i === 0 ? 0.85 : this.between(0.55, 0.8)) * radiusM;
      const upM = (i === 0 ? 0.44 : this.between(-0.67, 0.26)) * radiusM;
      this.clump([xM + outM * Math.cos(round), yM + upM, zM + outM * Math.sin(round)], [sizeM, 0.85 * sizeM, sizeM], leaves, sprigsCount);
    }
  }

  /** Adds a tree with a round crown. */
  tree([xM, yM, zM]: Point, highM: number, leaves: Leaves): void {
    const leanM = this.between(-0.05, 0.05) * highM;
    addRod(this.builder, [xM, yM - 0.2, zM], [xM + leanM, yM + 0.6 * highM, zM], 0.028 * highM, kBark, 6, 0.014 * highM);
    this.crown([xM + leanM, yM + 0.68 * highM, zM], 0.27 * highM, leaves);
  }

  /** Adds a tall slender tree. */
  cypress([xM, yM, zM]: Point, highM: number, leaves: Leaves): void {
    this.clump([xM, yM + 0.48 * highM, zM], [0.11 * highM, 0.53 * highM, 0.11 * highM], leaves);
  }

  /** Adds an umbrella pine: a trunk that leans, boughs, and a flat crown of clumps. */
  pine([xM, yM, zM]: Point, highM: number, leaves: Leaves): void {
    const top: Point = [xM + this.between(-0.15, 0.15) * highM, yM + 0.8 * highM, zM + this.between(-0.15, 0.15) * highM];
    const foot: Point = [xM, yM - 0.1 * highM, zM];
    addRod(this.builder, foot, top, 0.03 * highM, kBark, 5, 0.016 * highM);
    const turnRad = this.between(0, 2 * Math.PI);
    for (let lobe = 0; lobe < (this.plain ? 3 : 6); ++lobe) {
      const outM = lobe === 0 ? 0 : this.between(0.14, 0.24) * highM;
      const middle: Point = [top[0] + outM * Math.cos(turnRad + 2.4 * lobe), top[1] + (lobe === 0 ? 0.05 : this.between(-0.06, 0.02)) * highM, top[2] + outM * Math.sin(turnRad + 2.4 * lobe)];
      const wideM = (this.plain ? 0.24 : this.between(0.13, 0.19)) * highM;
      this.clump(middle, [wideM, 0.4 * wideM, wideM], leaves);
      // A bough from the upper part of the trunk.
      if (lobe > 0 && !this.plain) addRod(this.builder, foot.map((at, k) => mix(at, top[k]!, 0.72)) as unknown as Point, middle, 0.012 * highM, kBark, 3);
    }
  }

  private paint([first, second]: Leaves, bright: number, random = this.random): Paint {
    const share = random();
    const by = bright * mix(0.72, 1.28, random());
    return first.map((each, k) => (k < 3 ? by : 1) * mix(each, second[k]!, share)) as unknown as Paint;
  }
}

/** Returns the point of an ellipsoid, scaled by `size`, at an angle from its lowest point and one around it. */
function onEllipsoid(middle: Point, half: Point, upRad: number, roundRad: number, size: number): Point {
  const level = Math.sin(upRad);
  const outward = [level * Math.cos(roundRad), -Math.cos(upRad), level * Math.sin(roundRad)];
  return outward.map((each, k) => middle[k]! + size * half[k]! * each) as unknown as Point;
}

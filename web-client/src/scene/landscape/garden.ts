// The garden around a pool or a tank: a mown lawn, a border of shrubs and flowers, trees with sky between them, and furniture beside the water.
import { clamp } from "../maths/interpolate";
import { MeshBuilder, type Paint, type Point } from "../meshes/mesh_builder";
import { addPlate, addRod, addTurned } from "../meshes/shapes";
import { Foliage, kFarSprigsCount, type Leaves } from "./foliage";

interface GardenSize {
  /** Half of the water, or of the free space around a tank, along x and z. */
  halfM: readonly [number, number];
  /** Heights of the deck, and of the still water in a pool; undefined: a tank, beside which nobody bathes. */
  deckM: number;
  waterM?: number;
}

/** Width of the deck as a share of the border's distance, and at least. */
const kDeckShare = 0.5;
const kDeckLeastM = 2.4;
/** Distance of the border from the water, in sides of the water, and its bounds. */
const kAwaySides = 0.72;
const kAwayLimitsM = [3.6, 8.5] as const;
/** Height of trees where the border is furthest away; elsewhere in proportion. */
const kTreeM = 5.2;
const kLawnReachM = 600;
const kStripeM = 1.1;
const kSmallM = 8;
/** Shrubs on half of a side, at most: around large water they are larger. */
const kMostShrubs = 60;

const kDeck = [0.60, 0.52, 0.42] as const;
const kSlabM = 0.8;
const kLawns: readonly [Paint, Paint] = [[0.15, 0.25, 0.062, 1.1], [0.20, 0.31, 0.085, 1.1]];
const kMeadow: Paint = [0.17, 0.26, 0.08, 1];
const kBox: Leaves = [[0.10, 0.21, 0.045, 1.8], [0.21, 0.34, 0.075, 1.8]];
const kOlive: Leaves = [[0.16, 0.22, 0.10, 1.8], [0.33, 0.38, 0.20, 1.8]];
const kMaple: Leaves = [[0.13, 0.25, 0.05, 1.8], [0.33, 0.42, 0.10, 1.8]];
const kCypress: Leaves = [[0.05, 0.12, 0.045, 1.8], [0.10, 0.19, 0.06, 1.8]];
const kWood: Leaves = [[0.15, 0.24, 0.11, 1.8], [0.24, 0.33, 0.15, 1.8]];
const kLavender: Leaves = [[0.20, 0.24, 0.14, 1.8], [0.62, 0.42, 0.80, 1.8]];
const kRose: Leaves = [[0.20, 0.30, 0.09, 1.8], [0.98, 0.42, 0.50, 1.8]];
const kDaisy: Leaves = [[0.18, 0.29, 0.09, 1.8], [0.98, 0.96, 0.86, 1.8]];
const kFlowers: readonly Leaves[] = [kLavender, kRose, kDaisy];
const kTrees: readonly Leaves[] = [kMaple, kOlive, kBox];
const kSteel: Paint = [0.62, 0.66, 0.70, 0];
export const kTeak: Paint = [0.42, 0.25, 0.12, 0.5];
const kCushion: Paint = [0.90, 0.87, 0.80, 0.15];
const kTowels: readonly Paint[] = [[0.86, 0.30, 0.12, 0.2], [0.10, 0.42, 0.62, 0.2]];
const kCanvas: readonly [Paint, Paint] = [[0.92, 0.88, 0.78, 0.1], [0.80, 0.26, 0.14, 0.1]];
const kClay: Paint = [0.60, 0.27, 0.14, 0.5];
const kSoil: Paint = [0.085, 0.06, 0.04, 1];
/** Light of the sky on the deck around what stands there: reach, relative to its foot, and share. */
const kShade = [[0, 0.35], [0.85, 0.4], [1.15, 0.7], [1.8, 1]] as const;
/** Of what lies on the deck or the lawn, so that it does not flicker. */
const kLiftM = 0.004;

/** Returns the distance of the border from the water, and how high trees are over the deck. */
export function gardenReach(sideM: number): { awayM: number; treeM: number } {
  const awayM = clamp(kAwaySides * sideM, ...kAwayLimitsM);
  return { awayM, treeM: (kTreeM * awayM) / kAwayLimitsM[1] };
}

/** Returns the width of the deck around water of this side, and its paint, whose fourth number is the side of a slab in sides of the water (tiles.frag). */
export function deckOf(sideM: number): { widthM: number; paint: Paint } {
  return { widthM: Math.max(kDeckShare * gardenReach(sideM).awayM, kDeckLeastM), paint: [...kDeck, Math.min(kSlabM / sideM, 1 / 8)] };
}

/** Positions beside one side of the water: along it, height, and outward from its edge. */
type Beside = (alongM: number, yM: number, outM: number) => Point;

/** Darkens the deck around a foot of half this length and width. */
function addShade(deck: MeshBuilder, at: Beside, alongM: number, yM: number, outM: number, [halfAlongM, halfOutM]: readonly [number, number], [red, green, blue, tile]: Paint): void {
  const rows = kShade.map(([reach]) => Array.from({ length: 17 }, (_, n) => at(alongM + reach * halfAlongM * Math.cos((Math.PI * n) / 8), yM + kLiftM, outM - reach * halfOutM * Math.sin((Math.PI * n) / 8))));
  deck.grid(rows, (row) => { const share = kShade[row]![1]; return [share * red, share * green, share * blue, tile]; });
}

/** A sun bed whose head is outward, with a towel. */
function addSunBed(builder: MeshBuilder, at: Beside, alongM: number, deckM: number, outM: number, towel: Paint): void {
  const plate = (from: number, to: number, half: number, low: number, high: number, thickM: number, paint: Paint): void => {
    const corner = (side: number, yM: number, awayM: number): Point => at(alongM + side * half, deckM + yM, outM + awayM);
    addPlate(builder, [corner(-1, low, from), corner(1, low, from), corner(1, high, to), corner(-1, high, to)], thickM, paint);
  };
  for (const [along, out] of [[-0.26, 0.1], [0.26, 0.1], [-0.26, 1.6], [0.26, 1.6]] as const)
    addRod(builder, at(alongM + along, deckM, outM + out), at(alongM + along, deckM + 0.3, outM + out), 0.035, kTeak);
  plate(0, 1.9, 0.34, 0.32, 0.32, 0.07, kTeak);
  plate(0.03, 1.2, 0.31, 0.42, 0.42, 0.1, kCushion);
  plate(1.2, 1.85, 0.31, 0.42, 0.86, 0.1, kCushion);
  plate(0.25, 0.75, 0.315, 0.425, 0.425, 0.08, towel);
}

/** A parasol; its canvas is seen from both sides. */
function addParasol(builder: MeshBuilder, [xM, deckM, zM]: Point): void {
  const sidesCount = 8;
  addRod(builder, [xM, deckM, zM], [xM, deckM + 2.5, zM], 0.03, kTeak, 6);
  addRod(builder, [xM, deckM, zM], [xM, deckM + 0.1, zM], 0.28, kCushion, 10, 0.26);
  const top: Point = [xM, deckM + 2.62, zM];
  const rim = (n: number, downM = 0): Point => {
    const round = (-2 * Math.PI * n) / sidesCount;
    return [xM + 1.45 * Math.cos(round), deckM + 2.08 - downM, zM + 1.45 * Math.sin(round)];
  };
  for (let n = 0; n < sidesCount; ++n) {
    const paint = kCanvas[n % 2]!;
    builder.quad(rim(n), rim(n + 1), top, top, paint).quad(rim(n + 1), rim(n), top, top, paint);
    builder.quad(rim(n, 0.16), rim(n + 1, 0.16), rim(n + 1), rim(n), paint);
    builder.quad(rim(n + 1, 0.16), rim(n, 0.16), rim(n), rim(n + 1), paint);
  }
}

function addPot(builder: MeshBuilder, plants: Foliage, [xM, deckM, zM]: Point, leaves: Leaves): void {
  const turn = (yM: number, radiusM: number): { yM: number; radiusM: number; paint: Paint } => ({ yM, radiusM, paint: kClay });
  addTurned(builder, [xM, deckM, zM], [turn(0, 0.2), turn(0.42, 0.31), turn(0.42, 0.35), turn(0.52, 0.35), turn(0.52, 0.28), turn(0.48, 0)], 12);
  plants.clump([xM, deckM + 0.8, zM], [0.4, 0.42, 0.4], leaves);
}

/** A ladder of steel at the water's edge: two bent rails and three steps. */
function addLadder(builder: MeshBuilder, at: Beside, alongM: number, waterM: number, deckM: number): void {
  const footM = Math.max(waterM - 1, 0.1 * waterM);
  const handM = deckM + 0.82;
  for (const across of [-0.27, 0.27]) {
    const bends = [[-0.16, footM], [-0.16, handM - 0.12], [-0.1, handM], [0.02, handM + 0.04], [0.4, handM - 0.02], [0.5, handM - 0.14], [0.52, deckM]];
    const rail = bends.map(([outM, yM]) => at(alongM + across, yM!, outM!));
    for (let n = 0; n + 1 < rail.length; ++n) addRod(builder, rail[n]!, rail[n + 1]!, 0.026, kSteel, 8);
  }
  for (const yM of [0.25, -0.1, -0.45, -0.8]) {
    const y = waterM + yM;
    const corner = (across: number, outM: number): Point => at(alongM + 0.27 * across, y, outM);
    if (y > footM && y < deckM + 0.1) addPlate(builder, [corner(-1, -0.23), corner(1, -0.23), corner(1, -0.1), corner(-1, -0.1)], 0.035, kSteel);
  }
}

/** A border of shrubs with flowers before it; its length is that of the side with the corners. */
function addBorder(plants: Foliage, at: Beside, longM: number, deckM: number, awayM: number, treeM: number): void {
  const stepM = Math.max((plants.plain ? 0.4 : 0.22) * treeM, longM / kMostShrubs);
  const soil = (alongM: number, outM: number): Point => at(alongM, deckM + kLiftM, awayM + outM * stepM);
  plants.builder.quad(soil(-longM, -1.5), soil(longM, -1.5), soil(longM, 1), soil(-longM, 1), kSoil);
  let flower = 0;
  for (let alongM = -longM; alongM < longM; alongM += stepM * plants.between(0.8, 1.2)) {
    const sizeM = stepM * plants.between(0.6, 1.05);
    const highM = sizeM * plants.between(0.8, 1.25);
    const kind = plants.between(0, 1);
    const leaves = kind < 0.6 ? kBox : kind < 0.85 ? kOlive : kRose;
    plants.clump(at(alongM, deckM + 0.7 * highM, awayM + plants.between(0, 0.6) * stepM), [sizeM, highM, sizeM], leaves);
    if (plants.between(0, 1) < 0.2) ++flower;
    const lowM = 0.42 * stepM * plants.between(0.7, 1.2);
    const before = at(alongM + 0.3 * stepM, deckM + 0.6 * lowM, awayM - 0.95 * stepM);
    plants.clump(before, [1.3 * lowM, lowM, lowM], kFlowers[flower % kFlowers.length]!);
  }
}

/** Adds lawn in stripes up to `reachM` from the middle, and meadow beyond. */
function addLawn(builder: MeshBuilder, yM: number, inner: readonly [number, number], reachM: number): void {
  const strip = (x0: number, x1: number, z0: number, z1: number, paint: Paint): void => {
    if (x1 > x0 && z1 > z0) builder.quad([x0, yM, z1], [x1, yM, z1], [x1, yM, z0], [x0, yM, z0], paint);
  };
  const [ix, iz] = inner;
  let x = -reachM;
  for (let n = 0; x < reachM; ++n, x += kStripeM) {
    const [toX, paint] = [Math.min(x + kStripeM, reachM), kLawns[n % 2]!];
    strip(x, Math.min(toX, -ix), -reachM, reachM, paint);
    strip(Math.max(x, ix), toX, -reachM, reachM, paint);
    for (const [z0, z1] of [[-reachM, -iz], [iz, reachM]] as const) strip(Math.max(x, -ix), Math.min(toX, ix), z0, z1, paint);
  }
  const far = kLawnReachM;
  strip(-far, far, reachM, far, kMeadow);
  strip(-far, far, -far, -reachM, kMeadow);
  strip(-far, -reachM, -reachM, reachM, kMeadow);
  strip(reachM, far, -reachM, reachM, kMeadow);
}

/** Adds everything that stands on the deck and on the lawn, and its shade on the deck, whose paint this is. */
export function addGarden(builder: MeshBuilder, deck: MeshBuilder, paint: Paint, size: GardenSize, plain: boolean): void {
  const { deckM, waterM, halfM } = size;
  const [halfX, halfZ] = halfM;
  const sideM = 2 * Math.max(halfX, halfZ);
  const { awayM, treeM } = gardenReach(sideM);
  const { widthM: deckWidthM } = deckOf(sideM);
  const plants = new Foliage(builder, plain ? "plain" : "garden");
  const lawnM = deckM - 0.03;
  addLawn(builder, lawnM, [halfX + deckWidthM - 0.02, halfZ + deckWidthM - 0.02], Math.max(halfX, halfZ) + 3 * awayM);
  // The sides -z, +x, +z, -x: the direction along them and outward.
  const sides = ([[1, 0, 0, -1], [0, 1, 1, 0], [-1, 0, 0, 1], [0, -1, -1, 0]] as const).map(([ax, az, ox, oz]) => {
    const edgeM = Math.abs(ox) * halfX + Math.abs(oz) * halfZ;
    const at: Beside = (alongM, yM, outM) => [alongM * ax + (edgeM + outM) * ox, yM, alongM * az + (edgeM + outM) * oz];
    return { at, halfM: Math.abs(ax) * halfX + Math.abs(az) * halfZ };
  });
  const seat = Math.max(1.1, 0.5 * deckWidthM);
  sides.forEach(({ at, halfM: half }, side) => {
    // The usual view comes from +z: nothing high stands there.
    const isOpen = side === 2;
    if (!isOpen) addBorder(plants, at, half + awayM, lawnM, awayM, treeM);
    for (let n = -3; n <= 3; ++n) {
      const alongM = (n / 3) * (half + 1.2 * awayM) + plants.between(-0.25, 0.25) * treeM;
      const outM = awayM * (isOpen ? 2.6 : 1.22) + plants.between(0, 0.3) * treeM;
      const kind = plants.between(0, 1);
      if (kind < 0.22) continue;
      if (kind < 0.42) plants.cypress(at(alongM, lawnM, outM), treeM * plants.between(0.95, 1.35), kCypress);
      else plants.tree(at(alongM, lawnM, outM), treeM * plants.between(0.7, 1.15), kTrees[Math.floor(3 * plants.between(0, 0.999))]!);
    }
    // Woods beyond.
    for (let n = -7; n <= 7; ++n) {
      const highM = treeM * plants.between(0.7, 1.5);
      const middle = at((n / 7) * (half + 4 * awayM) + plants.between(-1, 1), lawnM + 0.4 * highM, 3.4 * awayM + plants.between(0, 1) * awayM);
      if (plain) plants.clump(middle, [0.8 * highM, 0.65 * highM, 0.8 * highM], kWood);
      else plants.crown(middle, 0.6 * highM, kWood, kFarSprigsCount);
    }
    if (waterM !== undefined && (side === 0 || (isOpen && sideM > kSmallM))) addLadder(builder, at, 0.5 * half, waterM, deckM);
    // Beside a small pool, nothing stands where the first views come from.
    if (sideM < kSmallM && side >= 2) return;
    const shade = (alongM: number, outM: number, foot: readonly [number, number]): void => addShade(deck, at, alongM, deckM, outM, foot, paint);
    const groupM = (side === 0 ? -0.15 : 0.2) * half;
    if (waterM !== undefined) {
      addParasol(builder, at(groupM, deckM, seat + 0.9));
      shade(groupM, seat + 0.9, [0.3, 0.3]);
      for (const n of [0, 1]) {
        const alongM = groupM + (n === 0 ? -1.0 : 0.75);
        addSunBed(builder, at, alongM, deckM, seat - 0.3, kTowels[(side + n) % 2]!);
        shade(alongM, seat + 0.6, [0.42, 1.05]);
      }
    }
    const potsM = sideM < kSmallM ? [-half - 0.7, half + 0.6] : [-0.62 * half, 0.78 * half];
    for (const alongM of potsM) {
      addPot(builder, plants, at(alongM, deckM, seat), alongM < 0 ? kOlive : kRose);
      shade(alongM, seat, [0.24, 0.24]);
    }
  });
}

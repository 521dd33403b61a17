// The ground of an open sea: the bed under the square and around it, beaches that continue along the coast, dunes and hills behind them, and
// at closed sides without a beach quays, or rocky shores where the scene has a beach elsewhere. Pure.
import type { BufferGeometry } from "three";

import { hasRockyShores, kSideNames, type SideKind, type SideName } from "../../../client/codec/scene_info";
import { clamp, mix, smoothstep } from "../maths/interpolate";
import { hash } from "../maths/random";
import { MeshBuilder, type Paint, type Point } from "../meshes/mesh_builder";
import { Foliage } from "./foliage";
import { bedPaint, mixPaint } from "./paints";
import { addVillage, kLandLeaves, type Land } from "./village";
import { depthAtM, insideM, isShoreDepth, longSideM, type Bed } from "./terrain";

interface Coast {
  bed: Bed;
  sides: Readonly<Record<SideName, SideKind>>;
}

/** Height of a quay over the still water, as a share of the side, and its bounds in metres. */
const kQuaySides = 0.03;
const kQuayMinM = 0.25;
const kQuayMaxM = 2.5;
/** In the plain tiers its wall ends at this share of the depth: through their water it would be a dark band. */
const kPlainWallDepths = 0.3;
/** Where a ground is looked at along a side. */
const kSideSamples = [-0.45, -0.3, -0.15, 0, 0.15, 0.3, 0.45] as const;
/** Slope behind a shore that no beach makes. */
const kShoreSlope = 0.1;
/** Dunes and hills, in sides of the square: height, and the distances over which the hills rise. */
const kDuneSides = 0.06;
const kHillSides = 0.85;
const kHillsFromSides = 1.1;
const kHillsToSides = 9;
/** Width of the paving behind a quay, in sides. */
const kPavingSides = 0.06;
/** The ground is drawn out to this many sides, under water only out to kBedReachSides. */
const kReachSides = 40;
const kBedReachSides = 0.45;
/** Cells outside the square become larger by this factor; the second if there are few of them. */
const kGrowth = 1.35;
const kCoarseGrowth = 1.7;
const kFewCells = 64;

/** Pines grow where the bed is higher over the water than this share of its depth: places to try, and the most of them. */
const kPineDepths = 0.6;
const kPinePlaces = 400;
const kPinesMost = 9;

const kGrass: Paint = [0.17, 0.185, 0.085, 1.0];
const kFarGrass: Paint = [0.085, 0.125, 0.075, 0.6];
const kPaving: Paint = [0.45, 0.42, 0.37, 0.8];
const kQuayWall: Paint = [0.34, 0.31, 0.27, 1.0];
const kCliff: Paint = [0.3, 0.27, 0.23, 1.0];
/** Rows of boulders before a rocky shore, and how far they reach into the water, m: the simulated side is a wall. */
const kBoulderRows = 6;
const kBoulderReachM = 0.6;

/** Gentle rolling in -1..1: sines with no common period. */
function rolling(x: number, z: number): number {
  return 0.5 * Math.sin(x + 1.7 * Math.sin(0.31 * z)) * Math.sin(0.83 * z + 0.4) + 0.3 * Math.sin(2.3 * x - 1.1 * z + 2) + 0.2 * Math.sin(0.37 * x + 0.53 * z);
}

/** Beyond the square a shore comes forward, and rocky land draws back, by up to this many sides, half of it within the second number of sides. */
const kBendSides = 0.45;
const kHalfBendSides = 1.6;

/** Returns how far the coast at a side has moved at a point: toward the water at a shore, away from it at other land; 0 along the square. */
function bendM(coast: Coast, side: SideName, xM: number, zM: number): number {
  const { bed, sides } = coast;
  const sideM = longSideM(bed);
  const [beyondM, end] = side[1] === "x" ? [Math.abs(zM) - bed.widthM / 2, zM > 0 ? "+z" : "-z"] : [Math.abs(xM) - bed.sideM / 2, xM > 0 ? "+x" : "-x"];
  // Only where the coast runs out into the open sea.
  if (beyondM <= 0 || sides[end as SideName] === "closed") return 0;
  const beyond = beyondM / sideM;
  const wavy = 1 + 0.35 * Math.sin(2.1 * beyond + (zM > 0 ? 1 : 4)) + 0.2 * Math.sin(5.3 * beyond);
  return (isShore(coast, side) ? 1 : -1) * kBendSides * sideM * wavy * (beyond ** 2 / (beyond ** 2 + kHalfBendSides ** 2));
}

/** Returns the distance of a point from the coast at a side, on the land. */
function outOfM(coast: Coast, side: SideName, xM: number, zM: number): number {
  return bendM(coast, side, xM, zM) - insideM(side, coast.bed, xM, zM);
}

/** The sides of a coast that are shores: asked for at every point of its ground. */
const shores = new WeakMap<Coast, ReadonlySet<SideName>>();

function isShore(coast: Coast, side: SideName): boolean {
  const known = shores.get(coast) ?? new Set(kSideNames.filter((each) => isShallow(coast, each)));
  shores.set(coast, known);
  return known.has(side);
}

/** A closed side whose bed is shallow is a shore, otherwise a quay. */
function isShallow({ bed }: Coast, side: SideName): boolean {
  if (!bed.ground) return bed.beaches.some((beach) => beach.side === side && isShoreDepth(bed, beach.shoreDepthM));
  const sign = side[0] === "+" ? 1 : -1;
  const { sideM, widthM } = bed;
  const depthsM = kSideSamples.map((share) => (side[1] === "x" ? depthAtM(bed, (sign * sideM) / 2, share * widthM) : depthAtM(bed, share * sideM, (sign * widthM) / 2)));
  return depthsM.every((depthM) => isShoreDepth(bed, depthM));
}

export function quayHeightM(bed: Bed): number {
  return clamp(kQuaySides * longSideM(bed), kQuayMinM, kQuayMaxM);
}

/** Returns the height of the ground, y = 0 at the still water. `pastQuay`: on the land side of a quay where the point is on its edge. */
export function coastHeightM(coast: Coast, xM: number, zM: number, pastQuay = false): number {
  const { bed, sides } = coast;
  const sideM = longSideM(bed);
  let heightM = -depthAtM(bed, xM, zM);
  for (const side of kSideNames) {
    if (sides[side] !== "closed") continue;
    const movedM = bendM(coast, side, xM, zM);
    const outM = movedM - insideM(side, bed, xM, zM);
    // The bed comes forward with its shore.
    if (movedM > 0) heightM = Math.max(heightM, -(side[1] === "x" ? depthAtM(bed, xM + Math.sign(xM) * movedM, zM) : depthAtM(bed, xM, zM + Math.sign(zM) * movedM)));
    if (outM < -1e-9) continue;
    const hillsM = kHillSides * sideM * smoothstep(kHillsFromSides, kHillsToSides, outM / sideM) * (0.55 + 0.45 * rolling((3.1 * xM) / sideM / 3, (3.1 * zM) / sideM / 3));
    const roll = rolling((9 * xM) / sideM, (9 * zM) / sideM);
    if (isShore(coast, side)) {
      const beach = bed.ground ? undefined : bed.beaches.find((each) => each.side === side);
      const edgeM = beach ? -beach.shoreDepthM : heightM;
      const topM = kDuneSides * sideM * (0.75 + 0.35 * roll);
      const slope = beach ? Math.min((bed.depthM - beach.shoreDepthM) / beach.widthM, 0.25) : kShoreSlope;
      heightM = Math.max(heightM, edgeM + topM * (1 - Math.exp((-slope * Math.max(outM, 0)) / topM)) + hillsM);
    } else if (outM > 1e-9 || pastQuay) {
      const uneven = hasRockyShores(bed.beaches) ? 1 + 0.45 * rolling((11 * xM) / sideM, (11 * zM) / sideM) + 0.22 * rolling((37 * xM) / sideM, (41 * zM) / sideM) : 1;
      heightM = Math.max(heightM, uneven * quayHeightM(bed) + 0.3 * kDuneSides * sideM * (1 + roll) * smoothstep(0.25, 1, outM / sideM) + hillsM);
    }
  }
  return heightM;
}

function paintAt(coast: Coast, [xM, yM, zM]: Point): Paint {
  const { bed, sides } = coast;
  const { depthM } = bed;
  const sideM = longSideM(bed);
  let paint = bedPaint(yM, depthM);
  for (const side of kSideNames) {
    if (sides[side] !== "closed") continue;
    const outM = outOfM(coast, side, xM, zM);
    if (outM < -1e-9) continue;
    const out = outM / sideM;
    const grass = mixPaint(kGrass, kFarGrass, smoothstep(0.5, 6, out));
    const patchy = 0.06 * rolling((23 * xM) / sideM, (23 * zM) / sideM);
    if (isShore(coast, side)) paint = mixPaint(paint, grass, smoothstep(0.16, 0.42, out + patchy) * smoothstep(0.4, 0.8, yM / (kDuneSides * sideM)));
    else if (yM > 0 && hasRockyShores(bed.beaches)) paint = mixPaint(kCliff, grass, smoothstep(0.02, 0.3, out + patchy));
    else if (yM > 0) paint = mixPaint(kPaving, grass, smoothstep(kPavingSides, kPavingSides + 0.01, out));
  }
  return paint;
}

/** Lines along one axis: dense over the square, growing beyond. Split into bands where a quay makes a step. */
function bandsOf(coast: Coast, axis: "x" | "z", cellsCount: number, descending: boolean): { at: number[]; low: boolean; high: boolean }[] {
  const sideM = longSideM(coast.bed);
  const lengthM = axis === "x" ? coast.bed.sideM : coast.bed.widthM;
  const half = lengthM / 2;
  const beyond: number[] = [];
  let step = lengthM / cellsCount;
  for (let at = half; at < kReachSides * sideM; ) {
    step *= cellsCount < kFewCells ? kCoarseGrowth : kGrowth;
    at += step;
    beyond.push(at);
  }
  // Where paving becomes grass.
  const extra = [kPavingSides, kPavingSides + 0.01].map((out) => half + out * sideM);
  const outer = [...beyond, ...extra].sort((a, b) => a - b);
  const inside = Array.from({ length: cellsCount + 1 }, (_, i) => (i / cellsCount - 0.5) * lengthM);
  const isQuay = (side: SideName): boolean => coast.sides[side] === "closed" && !isShore(coast, side);
  const below = outer.map((at) => -at).reverse();
  const bands: { at: number[]; low: boolean; high: boolean }[] = [];
  let lines = below;
  if (isQuay(`-${axis}`)) {
    bands.push({ at: [...lines, -half], low: false, high: true });
    lines = [];
  }
  lines = [...lines, ...inside];
  if (isQuay(`+${axis}`)) {
    bands.push({ at: lines, low: false, high: false });
    bands.push({ at: [half, ...outer], low: true, high: false });
  } else bands.push({ at: [...lines, ...outer], low: false, high: false });
  return descending ? bands.map(({ at, low, high }) => ({ at: [...at].reverse(), low: high, high: low })).reverse() : bands;
}

/** Returns the land behind a closed side. */
function landOf(coast: Coast, side: SideName): Land {
  const isX = side[1] === "x";
  const sign = side[0] === "+" ? 1 : -1;
  const halfM = (isX ? coast.bed.sideM : coast.bed.widthM) / 2;
  const pointAt = (alongM: number, outM: number): [number, number] => (isX ? [sign * (halfM + outM), alongM] : [alongM, sign * (halfM + outM)]);
  return {
    sideM: longSideM(coast.bed),
    seed: kSideNames.indexOf(side),
    facingRad: isX ? (-sign * Math.PI) / 2 : sign > 0 ? Math.PI : 0,
    groundAt(alongM, outM) {
      const [x, z] = pointAt(alongM, outM - bendM(coast, side, ...pointAt(alongM, 0)));
      const yM = coastHeightM(coast, x, z);
      return yM > 0 && outOfM(coast, side, x, z) > 0 ? [x, yM, z] : undefined;
    },
  };
}

/** Returns the ground as coloured triangles, with what stands on it. `plain`: without the bed at the scene's depth, for which the water has a colour. */
export function makeCoastGeometry(coast: Coast, cellsCount: number, plain: boolean): BufferGeometry {
  const { bed } = coast;
  const builder = new MeshBuilder();
  const [reachXM, reachZM] = [bed.sideM, bed.widthM].map((lengthM) => 0.5 * lengthM + kBedReachSides * longSideM(bed)) as [number, number];
  const isNear = ([x, y, z]: Point): boolean => (!plain || y > -0.999 * bed.depthM) && Math.abs(x) <= reachXM && Math.abs(z) <= reachZM;
  const isSeen = (points: readonly Point[]): boolean => points.some((point) => point[1] > -0.6 * bed.depthM || isNear(point));
  for (const zBand of bandsOf(coast, "z", cellsCount, true))
    for (const xBand of bandsOf(coast, "x", cellsCount, false)) {
      const pastQuay = [xBand, zBand].some(({ low, high }) => low || high);
      const rows = zBand.at.map((z) => xBand.at.map((x): Point => [x, coastHeightM(coast, x, z, pastQuay), z]));
      builder.grid(rows, (row, column) => paintAt(coast, rows[row]![column]!), isSeen);
    }
  addQuayWalls(coast, builder, cellsCount, plain ? kPlainWallDepths * bed.depthM : bed.depthM);
  const plants = new Foliage(builder, plain ? "plain" : "land");
  for (const side of kSideNames) if (coast.sides[side] === "closed") addVillage(builder, plants, landOf(coast, side));
  addPines(bed, plants);
  return builder.build();
}

/** Adds pines where the ground inside the square is high above the waves: on islands and dunes, not on beaches. */
function addPines(bed: Bed, plants: Foliage): void {
  if (!bed.ground) return;
  const high = Array.from({ length: kPinePlaces }, (_, n): Point => {
    const [x, z] = [(hash(n, 1, 71) - 0.5) * bed.sideM, (hash(n, 2, 71) - 0.5) * bed.widthM];
    return [x, -depthAtM(bed, x, z), z];
  }).filter(([, y]) => y > kPineDepths * bed.depthM);
  high.slice(0, kPinesMost).forEach((at, n) => plants.pine(at, longSideM(bed) * (0.06 + 0.03 * hash(n, 3, 71)), kLandLeaves));
}

function addQuayWalls(coast: Coast, builder: MeshBuilder, cellsCount: number, deepestM: number): void {
  for (const side of kSideNames) {
    const half = (side[1] === "x" ? coast.bed.sideM : coast.bed.widthM) / 2;
    if (coast.sides[side] !== "closed" || isShore(coast, side)) continue;
    const sign = side[0] === "+" ? 1 : -1;
    const along = bandsOf(coast, side[1] === "x" ? "z" : "x", cellsCount, false).flatMap(({ at }) => at);
    // The face looks toward the water: columns go right as seen from there.
    const ordered = (side[1] === "z") === (sign > 0) ? [...along].reverse() : along;
    const at = (t: number, past: boolean): Point => {
      const [x, z] = side[1] === "x" ? [sign * half, t] : [t, sign * half];
      const inward = 1 - 1e-6;
      return [x, past ? coastHeightM(coast, x, z, true) : coastHeightM(coast, side[1] === "x" ? x * inward : x, side[1] === "z" ? z * inward : z), z];
    };
    const low = ordered.map((t): Point => {
      const [x, y, z] = at(t, false);
      return [x, Math.max(y, -deepestM), z];
    });
    const high = ordered.map((t, i): Point => [low[i]![0], Math.max(at(t, true)[1], low[i]![1]), low[i]![2]]);
    if (!hasRockyShores(coast.bed.beaches)) {
      builder.grid([low, high], kQuayWall);
      continue;
    }
    const rows = Array.from({ length: kBoulderRows + 1 }, (_, row) =>
      low.map(([x, lowM, z], i): Point => {
        const share = row / kBoulderRows;
        const rise = row === 0 || row === kBoulderRows ? share : share * (0.85 + 0.3 * hash(i, row, 84));
        const outM = row === kBoulderRows ? 0 : kBoulderReachM * (1 - 0.5 * share) * hash(i, row, 83);
        return [x - (side[1] === "x" ? sign * outM : 0), mix(lowM, high[i]![1], rise), z - (side[1] === "z" ? sign * outM : 0)];
      }),
    );
    builder.grid(rows, (row, column) => kCliff.map((each, n) => (n < 3 ? each * (0.65 + 0.7 * hash(column, row, 85)) : each)) as unknown as Paint);
  }
}

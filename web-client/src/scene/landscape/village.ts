// What stands on the land behind a shore or a quay: a village whose houses face the water, a church among them, and trees round it and in
// woods on the hills. Sizes are shares of the square's longer side, so that they suit its boats and its lighthouse. Pure.
import { mix } from "../maths/interpolate";
import { hash } from "../maths/random";
import type { MeshBuilder, Paint, Point } from "../meshes/mesh_builder";
import { addTurned } from "../meshes/shapes";
import type { Foliage, Leaves } from "./foliage";

/** The land behind one side of the square. */
export interface Land {
  sideM: number;
  /** Tells the lands of a scene apart. */
  seed: number;
  /** Returns the point of the ground `alongM` the side from its middle and `outM` behind the coast, or nothing where there is water. */
  groundAt(alongM: number, outM: number): Point | undefined;
  /** Angle by which a house that faces +z has to be turned about the vertical to face the water, rad. */
  facingRad: number;
}

const kWalls: readonly Paint[] = [[0.74, 0.71, 0.65, 0.8], [0.78, 0.76, 0.72, 0.8], [0.66, 0.53, 0.36, 0.8], [0.52, 0.24, 0.17, 0.8], [0.50, 0.57, 0.60, 0.8]];
const kRoofs: readonly Paint[] = [[0.34, 0.115, 0.065, 0.9], [0.27, 0.095, 0.06, 0.9], [0.115, 0.12, 0.13, 0.9]];
/** Dark by day, and lit in the dark. */
const kWindow: Paint = [0.11, 0.085, 0.05, -1];
const kDarkWindow: Paint = [0.06, 0.065, 0.07, 0.2];
/** Of all plants behind a sea. */
export const kLandLeaves: Leaves = [[0.075, 0.125, 0.045, 1.8], [0.135, 0.185, 0.065, 1.8]];

const kHousesCount = { full: 46, plain: 20 };
const kTreesCount = { full: 150, plain: 36 };
/** Length of the usual house, in sides of the square. */
const kHouseSides = 0.068;

export function addVillage(builder: MeshBuilder, plants: Foliage, land: Land): void {
  const { sideM, seed } = land;
  const { plain } = plants;
  const middleM = 1.9 * (hash(seed, 1, 222) - 0.5) * sideM;
  const housesCount = plain ? kHousesCount.plain : kHousesCount.full;
  for (let n = 0; n < housesCount; ++n) {
    // In three lanes along the water, each less dense toward its ends.
    const lane = n % 3;
    const spread = (n + 0.25 + 0.5 * hash(n, seed, 42)) / housesCount - 0.5;
    const at = land.groundAt(middleM + spread * (1 + 1.8 * Math.abs(spread)) * 1.2 * sideM, (0.34 + 0.19 * lane + 0.06 * hash(n, seed, 43)) * sideM);
    if (at) addHouse(builder, land, at, n, plain);
  }
  const church = land.groundAt(middleM + 0.12 * sideM, 0.78 * sideM);
  if (church) addChurch(builder, land, church);
  const treesCount = plain ? kTreesCount.plain : kTreesCount.full;
  for (let n = 0; n < treesCount; ++n) {
    // Every third among the houses, the others in woods on the hills.
    const near = n % 3 === 0;
    const wood = hash(n % 11, seed, 44);
    const outSides = near ? 0.42 + 0.6 * hash(n, seed, 45) : 1 + 2.2 * hash(n % 11, seed, 46) + 0.45 * hash(n, seed, 47);
    const alongSides = near ? 2.2 * (hash(n, seed, 48) - 0.5) : 7 * (wood - 0.5) + 0.9 * (hash(n, seed, 49) - 0.5);
    const at = land.groundAt(middleM + alongSides * sideM, outSides * sideM);
    const sizeM = sideM * (0.034 + 0.03 * hash(n, seed, 50));
    if (at && n % 6 === 0) plants.pine(at, sideM * (0.09 + 0.03 * wood), kLandLeaves);
    else if (at) plants.clump([at[0], at[1] + 0.5 * sizeM, at[2]], [0.7 * sizeM, 0.8 * sizeM, 0.7 * sizeM], kLandLeaves);
  }
}

/** Returns the placement of points that are given in a house's own axes: x along its front, z toward the water. */
function placed([xM, yM, zM]: Point, angleRad: number): (point: Point) => Point {
  const [c, s] = [Math.cos(angleRad), Math.sin(angleRad)];
  return ([x, y, z]) => [xM + x * c + z * s, yM + y, zM - x * s + z * c];
}

interface Gabled {
  halfX: number;
  halfZ: number;
  eavesM: number;
  ridgeM: number;
  wall: Paint;
  roof: Paint;
}

/** Adds walls and a roof whose ridge runs along x. */
function addGabled(builder: MeshBuilder, place: (point: Point) => Point, { halfX, halfZ, eavesM, ridgeM, wall, roof }: Gabled): void {
  const quad = (corners: readonly [Point, Point, Point, Point], paint: Paint): void => {
    const [a, b, c, d] = corners.map(place) as [Point, Point, Point, Point];
    builder.quad(a, b, c, d, paint);
  };
  const sunkM = -eavesM;
  for (const side of [1, -1]) {
    const [x, z] = [side * halfX, side * halfZ];
    quad([[-x, sunkM, z], [x, sunkM, z], [x, eavesM, z], [-x, eavesM, z]], wall);
    quad([[x, sunkM, z], [x, sunkM, -z], [x, eavesM, -z], [x, eavesM, z]], wall);
    quad([[x, eavesM, z], [x, eavesM, -z], [x, ridgeM, 0], [x, ridgeM, 0]], wall);
    // The roof stands out a little.
    const [overX, overZ, lowM] = [1.06 * x, 1.14 * z, eavesM - 0.14 * (ridgeM - eavesM)];
    quad([[-overX, lowM, overZ], [overX, lowM, overZ], [overX, ridgeM, 0], [-overX, ridgeM, 0]], roof);
  }
}

function addHouse(builder: MeshBuilder, { sideM, seed, facingRad }: Land, at: Point, n: number, plain: boolean): void {
  const of = (salt: number): number => hash(n, seed, salt);
  const halfX = 0.5 * kHouseSides * sideM * mix(0.8, 1.35, of(51));
  const halfZ = halfX * mix(0.55, 0.8, of(52));
  const eavesM = halfX * mix(0.85, 1.3, of(53));
  const ridgeM = eavesM + halfZ * mix(0.8, 1.05, of(54));
  // Some show the water their gable.
  const isAcross = of(55) < 0.35;
  const place = placed(at, facingRad + 0.25 * (of(56) - 0.5) + (isAcross ? Math.PI / 2 : 0));
  const wall = kWalls[Math.floor(of(57) * kWalls.length)]!;
  addGabled(builder, place, { halfX, halfZ, eavesM, ridgeM, wall, roof: kRoofs[Math.floor(of(58) * kRoofs.length)]! });
  const windowM = 0.13 * halfX;
  const pane = (a: Point, b: Point, c: Point, d: Point, paint: Paint): void => void builder.quad(place(a), place(b), place(c), place(d), paint);
  const floors = eavesM > 1.05 * halfX ? [0.3, 0.72] : [0.5];
  for (const side of plain ? [1] : [1, -1])
    for (const floor of floors)
      for (const across of [-0.6, 0, 0.6]) {
        const paint = hash(n, Math.round(10 * (across + floor)) + 100 * side, 59) < 0.6 ? kWindow : kDarkWindow;
        const [y, tall] = [floor * eavesM, 1.3 * windowM];
        const [x, z] = [side * across * halfX, side * 1.015 * halfZ];
        pane([x - side * windowM, y - tall, z], [x + side * windowM, y - tall, z], [x + side * windowM, y + tall, z], [x - side * windowM, y + tall, z], paint);
        if (across === 0 || !isAcross) continue;
        const [gableX, gableZ] = [-side * 1.015 * halfX, side * across * 0.7 * halfZ];
        pane([gableX, y - tall, gableZ - side * windowM], [gableX, y - tall, gableZ + side * windowM], [gableX, y + tall, gableZ + side * windowM], [gableX, y + tall, gableZ - side * windowM], paint);
      }
  addGabled(builder, placed(place([0.5 * halfX, ridgeM, 0]), facingRad), { halfX: 0.09 * halfX, halfZ: 0.09 * halfX, eavesM: 0.28 * halfX, ridgeM: 0.29 * halfX, wall: kRoofs[0]!, roof: kRoofs[2]! });
}

function addChurch(builder: MeshBuilder, { sideM, facingRad }: Land, at: Point): void {
  const sizeM = kHouseSides * sideM;
  const place = placed(at, facingRad + 0.3);
  addGabled(builder, place, { halfX: 0.95 * sizeM, halfZ: 0.42 * sizeM, eavesM: 0.75 * sizeM, ridgeM: 1.35 * sizeM, wall: kWalls[1]!, roof: kRoofs[2]! });
  const tower = place([-1.15 * sizeM, 0, 0]);
  const turn = (yM: number, radiusM: number, paint: Paint): { yM: number; radiusM: number; paint: Paint } => ({ yM: yM * sizeM, radiusM: radiusM * sizeM, paint });
  addTurned(builder, tower, [turn(-1, 0.36, kWalls[1]!), turn(1.75, 0.34, kRoofs[2]!), turn(1.75, 0.42, kRoofs[2]!), turn(3, 0, kRoofs[2]!)], 4);
}

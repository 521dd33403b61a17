// A breakwater as triangles: caissons of concrete from the bed to a cap, stones at their foot, and a light at the end toward +x. Its
// middle is the origin, its length lies along x. The wall's outline is that of the scene; the stones stand out under water.
import type { BufferGeometry } from "three";

import type { BreakwaterInfo } from "../../../client/codec/scene_info";
import { clamp, mix } from "../maths/interpolate";
import { hash } from "../maths/random";
import { MeshBuilder, type Paint, type Point } from "../meshes/mesh_builder";
import { addRod, addTurned, type Turn } from "../meshes/shapes";
import { overgrown, shaded } from "./paints";
import { addPierGear } from "./pier_gear";

/** The light at the end of a wall. */
export type LightKind = "lighthouse" | "beacon";

interface Breakwater {
  geometry: BufferGeometry;
  /** Position of the light's lamp in the wall's own axes (z = 0). */
  lamp: { xM: number; yM: number };
}

const kConcrete: Paint = [0.40, 0.39, 0.365, 0.8];
const kCap: Paint = [0.50, 0.49, 0.46, 0.8];
const kJoint: Paint = [0.08, 0.08, 0.075, 1];
const kArmour: Paint = [0.27, 0.255, 0.235, 1];
const kIron: Paint = [0.05, 0.052, 0.055, 0.3];
const kWhite: Paint = [0.85, 0.85, 0.82, 0];
const kRed: Paint = [0.62, 0.05, 0.035, 0];
const kGreen: Paint = [0.03, 0.30, 0.13, 0];
const kGlass: Paint = [0.10, 0.13, 0.14, 0];
const kLantern: Paint = [0.16, 0.13, 0.08, -1];
const kCrates: readonly Paint[] = [[0.05, 0.16, 0.36, 0.3], [0.62, 0.19, 0.03, 0.3], [0.30, 0.20, 0.10, 0.8], [0.50, 0.50, 0.46, 0.3]];
const kLampPaints: Record<LightKind, Paint> = { lighthouse: [0.95, 0.85, 0.60, -1], beacon: [0.10, 0.75, 0.30, -1] };

/** Weed grows up to this share of the wall's height. */
const kWeedHeights = 0.11;
const kStonesMax = { full: 44, plain: 20 };

export function makeBreakwater(wall: BreakwaterInfo, depthM: number, light: LightKind, plain: boolean): Breakwater {
  const { lengthM, widthM, heightM } = wall;
  const builder = new MeshBuilder();
  const bottomM = -depthM - 0.05;
  const capM = Math.min(0.2 * heightM, 0.25 * widthM);
  addCaissons(builder, wall, bottomM, heightM - capM, plain);
  const [halfX, halfZ] = [lengthM / 2, widthM / 2];
  const edge = 0.15 * capM;
  builder.block(0, 0, { yM: heightM - capM, halfX, halfZ }, { yM: heightM - edge, halfX, halfZ }, kCap);
  builder.block(0, 0, { yM: heightM - edge, halfX, halfZ }, { yM: heightM, halfX: halfX - edge, halfZ: halfZ - edge }, kCap);
  const kerb = 0.07 * widthM;
  for (const side of [-1, 1]) {
    const low = { yM: heightM - 0.5 * edge, halfX: halfX - 2 * edge, halfZ: kerb };
    builder.block(0, side * (halfZ - edge - kerb), low, { ...low, yM: heightM + kerb, halfZ: 0.8 * kerb }, kConcrete);
  }
  addBollards(builder, wall, plain);
  addLampPosts(builder, wall, plain);
  addCrates(builder, wall);
  // On a shorter wall it would stand in the light's way.
  if (!plain && lengthM > 4 * widthM) addPierGear(builder, wall);
  addArmour(builder, wall, bottomM, plain ? kStonesMax.plain : kStonesMax.full);
  const xM = halfX - 0.55 * widthM;
  const yM = light === "lighthouse" ? addLighthouse(builder, xM, heightM, Math.min(2 * widthM, 5), plain) : addBeacon(builder, xM, heightM, widthM, plain);
  return { geometry: builder.build(), lamp: { xM, yM } };
}

/** Boxes side by side with joints between them, and weed at the water's level. */
function addCaissons(builder: MeshBuilder, { lengthM, widthM, heightM }: BreakwaterInfo, bottomM: number, topM: number, plain: boolean): void {
  const count = clamp(Math.round(lengthM / (1.5 * widthM)), 1, 60);
  const stepM = lengthM / count;
  const gapM = 0.012 * stepM;
  const weedM = kWeedHeights * heightM;
  const levels = [bottomM, -4 * weedM, -1.5 * weedM, 0.4 * weedM, 1.2 * weedM, 2.3 * weedM, topM].filter((yM, n, all) => n === 0 || (yM > bottomM && yM <= topM) || n === all.length - 1);
  for (let n = 0; n < count; ++n) {
    const [fromM, toM] = [-lengthM / 2 + n * stepM + (n > 0 ? gapM : 0), -lengthM / 2 + (n + 1) * stepM - (n + 1 < count ? gapM : 0)];
    const paint = shaded(kConcrete, 0.86 + 0.28 * hash(n, 3, 11));
    const face = (a: readonly [number, number], b: readonly [number, number]): void => {
      // Water that runs down has left streaks.
      const columnsCount = plain ? 1 : 3;
      const rows = levels.map((yM): Point[] => Array.from({ length: columnsCount + 1 }, (_, c) => [mix(a[0], b[0], c / columnsCount), yM, mix(a[1], b[1], c / columnsCount)]));
      builder.grid(rows, (row, column) => overgrown(shaded(paint, 1.1 - 0.4 * hash(n, column, 18) ** 2), levels[row]!, weedM * (0.75 + 0.5 * hash(n, column, 17))));
    };
    const half = widthM / 2;
    face([fromM, half], [toM, half]);
    face([toM, -half], [fromM, -half]);
    face([toM, half], [toM, -half]);
    face([fromM, -half], [fromM, half]);
  }
  const core = { halfX: 0.99 * (lengthM / 2), halfZ: 0.97 * (widthM / 2) };
  builder.block(0, 0, { yM: bottomM, ...core }, { yM: topM, ...core }, kJoint);
}

function addBollards(builder: MeshBuilder, { lengthM, widthM, heightM }: BreakwaterInfo, plain: boolean): void {
  const count = Math.min(Math.floor(lengthM / (2.2 * widthM)), 12);
  const size = 0.045 * widthM;
  for (let n = 0; n < count; ++n) {
    const x = lengthM * ((n + 0.5) / count - 0.5) - 0.3 * widthM;
    const z = 0.34 * widthM * (n % 2 === 0 ? 1 : -1);
    addTurned(builder, [x, heightM, z], [
      { yM: 0, radiusM: size, paint: kIron },
      { yM: 1.8 * size, radiusM: 0.9 * size, paint: kIron },
      { yM: 2 * size, radiusM: 1.5 * size, paint: kIron },
      { yM: 2.8 * size, radiusM: 1.3 * size, paint: kIron },
      { yM: 3 * size, radiusM: 0, paint: kIron },
    ], plain ? 5 : 8);
  }
}

/** Lamps on curved posts along the middle, but not where the light at the end stands. */
function addLampPosts(builder: MeshBuilder, { lengthM, widthM, heightM }: BreakwaterInfo, plain: boolean): void {
  const count = Math.min(Math.floor(lengthM / (2 * widthM)) - 1, 12);
  const high = Math.min(0.85 * widthM, 3);
  for (let n = 0; n < count; ++n) {
    const x = lengthM * ((n + 0.6) / (count + 1) - 0.5);
    const z = -0.3 * widthM;
    const neck: Point = [x, heightM + 0.93 * high, z];
    addRod(builder, [x, heightM, z], neck, 0.02 * high, kIron, plain ? 3 : 6, 0.013 * high);
    addRod(builder, neck, [x, heightM + high, z + 0.16 * high], 0.013 * high, kIron, plain ? 3 : 6);
    builder.block(x, z + 0.2 * high, { yM: heightM + 0.975 * high, halfX: 0.03 * high, halfZ: 0.07 * high }, { yM: heightM + 1.01 * high, halfX: 0.03 * high, halfZ: 0.07 * high }, kLantern, kIron);
  }
}

/** Fish boxes in small heaps. */
function addCrates(builder: MeshBuilder, { lengthM, widthM, heightM }: BreakwaterInfo): void {
  const size = Math.min(0.075 * widthM, 0.3);
  const heaps = Math.min(Math.floor(lengthM / (2.5 * widthM)), 8);
  for (let n = 0; n < 4 * heaps; ++n) {
    const heap = Math.floor(n / 4);
    const isUpper = n % 4 === 3;
    const x = lengthM * ((heap + 0.3 + 0.3 * hash(heap, 1, 36)) / heaps - 0.5) + 2.6 * size * (isUpper ? 0.6 : n % 4);
    const z = widthM * (0.1 + 0.14 * hash(heap, 2, 36));
    if (x > lengthM / 2 - 1.4 * widthM) continue;
    const yM = heightM + (isUpper ? 1.25 * size : 0);
    builder.block(x, z, { yM, halfX: 1.1 * size, halfZ: 0.75 * size }, { yM: yM + 1.2 * size, halfX: 1.15 * size, halfZ: 0.8 * size }, kCrates[Math.floor(hash(n, 3, 36) * kCrates.length)]!);
  }
}

/** Quarry stones along both sides: most of each is under water. */
function addArmour(builder: MeshBuilder, { lengthM, widthM, heightM }: BreakwaterInfo, bottomM: number, mostCount: number): void {
  const sizeM = Math.min(0.34 * widthM, 0.8);
  const count = Math.min(Math.round(lengthM / (0.8 * sizeM)), mostCount);
  for (const side of [-1, 1])
    for (let n = 0; n < count; ++n) {
      const seed = side + 2;
      const size = sizeM * (0.7 + 0.5 * hash(n, seed, 21));
      const x = (lengthM - 1.6 * sizeM) * ((n + 0.5) / count - 0.5);
      const topM = 0.05 - 0.3 * sizeM * hash(n, seed, 22);
      const out = widthM / 2 + size * (0.1 + 0.25 * hash(n, seed, 23));
      addStone(builder, [x, Math.max(topM - 0.55 * size, bottomM), side * out], size, n * 7 + seed, kWeedHeights * heightM, topM);
    }
}

/** A cuboid with corners that are out of place. */
function addStone(builder: MeshBuilder, [x, y, z]: Point, sizeM: number, seed: number, weedM: number, topM: number): void {
  const turn = Math.PI * hash(seed, 1, 31);
  const [c, s] = [Math.cos(turn), Math.sin(turn)];
  const corner = (sx: number, sy: number, sz: number): Point => {
    const key = (sx > 0 ? 1 : 0) + (sy > 0 ? 2 : 0) + (sz > 0 ? 4 : 0);
    const [a, b] = [0.5 * sizeM * sx * (0.7 + 0.4 * hash(seed, key, 32)), 0.42 * sizeM * sz * (0.7 + 0.4 * hash(seed, key, 33))];
    return [x + a * c - b * s, Math.min(y + 0.45 * sizeM * sy * (0.75 + 0.5 * hash(seed, key, 34)), topM), z + a * s + b * c];
  };
  const paint = shaded(kArmour, 0.75 + 0.5 * hash(seed, 2, 35));
  const face = (...points: [Point, Point, Point, Point]): void => {
    const [p, q, r, t] = points;
    const rows = [[p, q], [t, r]];
    builder.grid(rows, (row, column) => overgrown(paint, rows[row]![column]![1], weedM));
  };
  face(corner(-1, -1, 1), corner(1, -1, 1), corner(1, 1, 1), corner(-1, 1, 1));
  face(corner(1, -1, 1), corner(1, -1, -1), corner(1, 1, -1), corner(1, 1, 1));
  face(corner(1, -1, -1), corner(-1, -1, -1), corner(-1, 1, -1), corner(1, 1, -1));
  face(corner(-1, -1, -1), corner(-1, -1, 1), corner(-1, 1, 1), corner(-1, 1, -1));
  face(corner(-1, 1, 1), corner(1, 1, 1), corner(1, 1, -1), corner(-1, 1, -1));
}

/** Adds a round tower `high` metres high with a gallery and a lantern. Returns the height of its lamp. */
export function addLighthouse(builder: MeshBuilder, xM: number, baseM: number, high: number, plain: boolean): number {
  const sides = plain ? 8 : 18;
  const turn = (up: number, radius: number, paint: Paint): Turn => ({ yM: up * high, radiusM: radius * high, paint });
  const tower = Array.from({ length: 6 }, (_, n) => turn(0.06 + 0.116 * n, 0.098 - 0.0065 * n, n % 2 === 0 ? kWhite : kRed));
  addTurned(builder, [xM, baseM, 0], [
    turn(0, 0.15, kConcrete), turn(0.05, 0.145, kConcrete), turn(0.06, 0.13, kConcrete), turn(0.06, 0.098, kConcrete),
    ...tower,
    turn(0.745, 0.06, kWhite), turn(0.755, 0.098, kIron), turn(0.775, 0.098, kIron), turn(0.775, 0.055, kRed),
    turn(0.815, 0.055, kRed), turn(0.815, 0.048, kLampPaints.lighthouse), turn(0.905, 0.048, kIron),
    turn(0.905, 0.064, kRed), turn(0.93, 0.05, kRed), turn(0.96, 0.026, kRed), turn(0.975, 0.008, kIron), turn(1.03, 0.005, kIron), turn(1.035, 0, kIron),
  ], sides);
  // The door, toward the wall.
  const [nearM, wide] = [-0.103 * high, 0.026 * high];
  builder.block(xM + nearM, 0, { yM: baseM + 0.06 * high, halfX: 0.012 * high, halfZ: wide }, { yM: baseM + 0.165 * high, halfX: 0.014 * high, halfZ: wide }, kIron);
  for (const up of [0.32, 0.52]) builder.block(xM - (0.098 - 0.055 * (up - 0.06)) * high, 0, { yM: baseM + up * high, halfX: 0.006 * high, halfZ: 0.011 * high }, { yM: baseM + (up + 0.05) * high, halfX: 0.006 * high, halfZ: 0.011 * high }, kGlass);
  // The gallery's railing, and the bars of the lantern.
  const posts = plain ? 6 : 12;
  const at = (n: number, radius: number, up: number): Point => [xM + radius * high * Math.cos((2 * Math.PI * n) / posts), baseM + up * high, radius * high * Math.sin((2 * Math.PI * n) / posts)];
  for (let n = 0; n < posts; ++n) {
    addRod(builder, at(n, 0.092, 0.775), at(n, 0.092, 0.825), 0.0025 * high, kIron, 3);
    addRod(builder, at(n, 0.092, 0.825), at(n + 1, 0.092, 0.825), 0.0025 * high, kIron, 3);
    if (n % 2 === 0) addRod(builder, at(n, 0.05, 0.815), at(n, 0.05, 0.905), 0.004 * high, kIron, 3);
  }
  return baseM + 0.86 * high;
}

/** Adds a short green mast with a lamp. Returns the height of its lamp. */
function addBeacon(builder: MeshBuilder, xM: number, baseM: number, widthM: number, plain: boolean): number {
  const high = Math.min(1.1 * widthM, 2.6);
  const turn = (up: number, radius: number, paint: Paint): Turn => ({ yM: up * high, radiusM: radius * high, paint });
  addTurned(builder, [xM, baseM, 0], [
    turn(0, 0.2, kConcrete), turn(0.08, 0.19, kConcrete), turn(0.08, 0.09, kGreen), turn(0.4, 0.082, kWhite), turn(0.55, 0.079, kGreen),
    turn(0.74, 0.075, kIron), turn(0.74, 0.13, kIron), turn(0.77, 0.13, kIron), turn(0.77, 0.055, kLampPaints.beacon),
    turn(0.9, 0.055, kIron), turn(0.9, 0.075, kIron), turn(0.96, 0.02, kIron), turn(1, 0, kIron),
  ], plain ? 7 : 14);
  return baseM + 0.835 * high;
}

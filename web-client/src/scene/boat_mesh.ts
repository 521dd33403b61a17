// A boat's hull and cabin as triangles: pointed bow along +x, flat stern, deck, wheelhouse, mast. The origin is the hull's
// centre at half height, as on the wire; starboard is +z.
import type { BufferGeometry } from "three";

import type { BoatDetail } from "../codec/greeting";
import { MeshBuilder, type Paint, type Point } from "./mesh_builder";

const kStationsCount = 25;
const kUnderwater: Paint = [0.36, 0.06, 0.045, 0];
const kBootTop: Paint = [0.86, 0.87, 0.85, 0];
const kWood: Paint = [0.40, 0.23, 0.11, 0.25];
const kDeck: Paint = [0.55, 0.41, 0.26, 0.35];
const kInside: Paint = [0.72, 0.73, 0.70, 0];
const kCabin: Paint = [0.88, 0.88, 0.85, 0];
const kGlass: Paint = [0.02, 0.045, 0.06, 0];
const kMetal: Paint = [0.25, 0.27, 0.29, 0];
/** By boat id, so that boats can be told apart from a distance. */
const kHullColors: readonly Paint[] = [
  [0.05, 0.17, 0.36, 0], [0.62, 0.10, 0.06, 0], [0.04, 0.28, 0.20, 0], [0.78, 0.47, 0.05, 0], [0.30, 0.31, 0.33, 0], [0.02, 0.30, 0.38, 0],
];

function hullColor(boatId: number): Paint {
  return kHullColors[boatId % kHullColors.length]!;
}

/** Returns half the beam at `along` (-1 stern, 1 bow) as a share of half the greatest beam. */
export function breadthShare(along: number): number {
  if (along < 0) return 1 - 0.2 * along * along;
  return Math.sqrt(Math.max(1 - along ** 2.3, 0));
}

/** Returns the points from keel to deck at one station, on the starboard side; y from the hull's middle. */
function section(boat: BoatDetail, along: number): Point[] {
  const { lengthM, beamM, heightM } = boat;
  const half = heightM / 2;
  const breadth = (beamM / 2) * breadthShare(along);
  const bow = Math.max(along, 0);
  const keelY = -half + heightM * 0.8 * Math.max((along - 0.45) / 0.55, 0) ** 2.2;
  const sheerY = half + heightM * (0.3 * bow * bow + 0.06 * Math.min(along, 0) ** 2);
  const waterY = Math.max(-half + boat.draughtM + 0.05 * heightM, keelY + 0.05 * heightM);
  const bootY = waterY + 0.07 * heightM;
  const chineY = keelY + 0.32 * (waterY - keelY);
  // The stem leans forward: higher points lie further ahead.
  const x = (y: number): number => (along * lengthM) / 2 - 0.10 * lengthM * bow ** 3 * (1 - (y + half) / (sheerY + half));
  const rail = 0.045 * beamM;
  const deckY = sheerY - 0.14 * heightM;
  const flare = 1 - 0.5 * bow;
  return [
    [x(keelY), keelY, 0],
    [x(chineY), chineY, 0.78 * flare * breadth],
    [x(waterY), waterY, (0.93 - 0.25 * bow) * breadth],
    [x(bootY), bootY, (0.945 - 0.22 * bow) * breadth],
    [x(sheerY), sheerY, breadth],
    [x(sheerY), sheerY, Math.max(breadth - rail, 0)],
    [x(deckY), deckY, Math.max(breadth - 1.15 * rail, 0)],
  ];
}

const mirrored = ([x, y, z]: Point): Point => [x, y, -z];

export function makeBoatGeometry(boat: BoatDetail): BufferGeometry {
  const { lengthM, beamM, heightM } = boat;
  const builder = new MeshBuilder();
  const paint = hullColor(boat.boatId);
  const stations = Array.from({ length: kStationsCount }, (_, i) => section(boat, (2 * i) / (kStationsCount - 1) - 1));
  const bands: [from: number, to: number, paint: Paint][] = [
    [0, 2, kUnderwater], [2, 3, kBootTop], [3, 4, paint], [4, 5, kWood], [5, 6, kInside],
  ];
  for (const [from, to, color] of bands) {
    const rows = Array.from({ length: to - from + 1 }, (_, i) => stations.map((points) => points[from + i]!));
    builder.grid(rows, color);
    builder.grid(rows.map((row) => row.map(mirrored).reverse()), color);
  }
  const rim = stations.map((points) => points[6]!);
  builder.grid([rim, rim.map(mirrored)], kDeck);
  // The stern, one band at a time like the sides.
  const stern = stations[0]!;
  for (const [from, to, color] of bands.slice(0, 3))
    for (let i = from; i < to; ++i) builder.quad(mirrored(stern[i]!), stern[i]!, stern[i + 1]!, mirrored(stern[i + 1]!), color);
  builder.quad(mirrored(stern[4]!), stern[4]!, [stern[4]![0] + 0.03 * lengthM, stern[4]![1], stern[4]![2]], [stern[4]![0] + 0.03 * lengthM, stern[4]![1], -stern[4]![2]], kWood);
  addWheelhouse(builder, lengthM, beamM, heightM, paint);
  return builder.build();
}

function addWheelhouse(builder: MeshBuilder, lengthM: number, beamM: number, heightM: number, paint: Paint): void {
  const deckY = heightM * 0.5 - 0.14 * heightM;
  const xM = -0.10 * lengthM;
  const high = Math.min(0.85 * heightM, 0.75 * beamM);
  const low = { yM: deckY, halfX: 0.17 * lengthM, halfZ: 0.29 * beamM };
  const top = { yM: deckY + high, halfX: 0.145 * lengthM, halfZ: 0.26 * beamM };
  builder.block(xM, 0, low, top, kCabin);
  // Windows: faces just outside the upper part of the walls.
  const at = (share: number, out: number) => ({
    yM: low.yM + share * high,
    halfX: low.halfX + share * (top.halfX - low.halfX) + out,
    halfZ: low.halfZ + share * (top.halfZ - low.halfZ) + out,
  });
  const out = 0.006 * beamM;
  const [sill, lintel] = [at(0.48, out), at(0.88, out)];
  const post = 0.12;
  for (const side of [-1, 1]) {
    const z = (level: typeof sill): number => side * level.halfZ;
    for (const [a, b] of [[-0.84, -0.08], [0.08, 0.84]] as const) {
      const corners: Point[] = [[xM + a * sill.halfX, sill.yM, z(sill)], [xM + b * sill.halfX, sill.yM, z(sill)], [xM + b * lintel.halfX, lintel.yM, z(lintel)], [xM + a * lintel.halfX, lintel.yM, z(lintel)]];
      if (side < 0) corners.reverse();
      builder.quad(...(corners as [Point, Point, Point, Point]), kGlass);
    }
    const x = (level: typeof sill): number => xM + side * level.halfX;
    const wide = 1 - post;
    const corners: Point[] = [[x(sill), sill.yM, wide * sill.halfZ], [x(sill), sill.yM, -wide * sill.halfZ], [x(lintel), lintel.yM, -wide * lintel.halfZ], [x(lintel), lintel.yM, wide * lintel.halfZ]];
    if (side < 0) corners.reverse();
    builder.quad(...(corners as [Point, Point, Point, Point]), kGlass);
  }
  const roofLow = { yM: top.yM, halfX: 1.14 * top.halfX, halfZ: 1.14 * top.halfZ };
  builder.block(xM, 0, roofLow, { yM: top.yM + 0.09 * heightM, halfX: 1.04 * top.halfX, halfZ: 1.04 * top.halfZ }, paint);
  const mast = 0.018 * lengthM;
  const mastX = xM - 0.5 * top.halfX;
  builder.block(mastX, 0, { yM: top.yM, halfX: mast, halfZ: mast }, { yM: top.yM + 0.75 * heightM, halfX: 0.5 * mast, halfZ: 0.5 * mast }, kMetal);
  const flagY = top.yM + 0.5 * heightM;
  for (const z of [0.3 * mast, -0.3 * mast]) {
    const flag: Point[] = [[mastX - 0.11 * lengthM, flagY, z], [mastX, flagY, z], [mastX, flagY + 0.22 * heightM, z], [mastX - 0.11 * lengthM, flagY + 0.22 * heightM, z]];
    if (z < 0) flag.reverse();
    builder.quad(...(flag as [Point, Point, Point, Point]), paint);
  }
  // A hatch on the fore deck.
  builder.block(0.22 * lengthM, 0, { yM: deckY, halfX: 0.055 * lengthM, halfZ: 0.11 * beamM }, { yM: deckY + 0.13 * heightM, halfX: 0.05 * lengthM, halfZ: 0.10 * beamM }, kWood);
}

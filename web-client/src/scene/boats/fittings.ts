// What stands on and in a hull: wheelhouse, cuddy, seats, motor, mast, rails. Sizes follow from the hull's.
import { shaded } from "../landscape/paints";
import type { MeshBuilder, Paint, Point } from "../meshes/mesh_builder";
import { addPerson } from "../meshes/person";
import { addPlate, addRod, addTurned, addWindow, type Turn } from "../meshes/shapes";
import type { HullLines } from "./lines";
import { kBlack, kCanvas, kGlass, kMetal, kSteel, type Livery } from "./livery";

/** A navigation light: its position on the boat, and its kind, from which colour and sector follow (boat_lamps.ts). */
export interface BoatLamp {
  at: Point;
  kind: "port" | "starboard" | "masthead" | "stern" | "allRound";
}

const kWhiteLamp: Paint = [0.95, 0.92, 0.80, -1];
const kLampPaints: Record<BoatLamp["kind"], Paint> = { port: [0.75, 0.05, 0.04, -1], starboard: [0.04, 0.55, 0.20, -1], masthead: kWhiteLamp, stern: kWhiteLamp, allRound: kWhiteLamp };

const kFender: Paint = [0.62, 0.60, 0.55, 0.2];
const kRope: Paint = [0.36, 0.29, 0.18, 0.8];
const kFishBoxes: readonly Paint[] = [[0.08, 0.15, 0.26, 0.3], [0.40, 0.17, 0.06, 0.3]];
/** Height of a person, in beams of a dinghy, and of a larger boat. */
const kSeatedBeams = 1.25;
const kPersonBeams = 0.54;

export interface Detail {
  /** Sides of round things. */
  sidesCount: number;
  /** With rails, more windows, and set in. */
  isFine: boolean;
}

/** Adds what a hull carries, and returns its lights. */
export function addFittings(builder: MeshBuilder, lines: HullLines, livery: Livery, detail: Detail): BoatLamp[] {
  const lamps = { dinghy: fitDinghy, launch: fitLaunch, cutter: fitCutter }[lines.kind](builder, lines, livery, detail);
  const size = Math.min(0.015 * lines.boat.beamM + 0.004, 0.05);
  for (const { at, kind } of lamps) {
    const [x, y, z] = at;
    if (detail.isFine) builder.block(x, z, { yM: y - 1.6 * size, halfX: 0.7 * size, halfZ: 0.7 * size }, { yM: y - size, halfX: size, halfZ: size }, kBlack);
    builder.block(x, z, { yM: y - size, halfX: size, halfZ: size }, { yM: y + size, halfX: size, halfZ: size }, kLampPaints[kind], kBlack);
  }
  return lamps;
}

/** A seat across the hull, from side to side. */
function addThwart(builder: MeshBuilder, lines: HullLines, along: number, wide: number, yM: number, paint: Paint): void {
  const half = wide / 2;
  const [aft, ahead] = [lines.inside(along - half, yM), lines.inside(along + half, yM)];
  addPlate(builder, [[aft[0], yM, -aft[2]], [aft[0], yM, aft[2]], [ahead[0], yM, ahead[2]], [ahead[0], yM, -ahead[2]]], 0.035 * lines.boat.heightM, paint);
}

/** Outboard motor behind the transom: cowl, leg, and the bracket that holds it. */
function addMotor(builder: MeshBuilder, lines: HullLines): void {
  const { heightM, beamM } = lines.boat;
  const top = lines.sheerM(0);
  const x = lines.xM(0, top) - 0.035 * beamM;
  const size = 0.08 * beamM;
  builder.block(x, 0, { yM: -0.45 * heightM, halfX: 0.45 * size, halfZ: 0.2 * size }, { yM: top, halfX: 0.6 * size, halfZ: 0.4 * size }, kMetal);
  builder.block(x, 0, { yM: top - 0.04 * heightM, halfX: 0.8 * size, halfZ: 0.62 * size }, { yM: top + 0.16 * heightM, halfX: 0.9 * size, halfZ: 0.66 * size }, kBlack);
  builder.block(x, 0, { yM: top + 0.16 * heightM, halfX: 0.9 * size, halfZ: 0.66 * size }, { yM: top + 0.28 * heightM, halfX: 0.6 * size, halfZ: 0.5 * size }, kBlack);
  addRod(builder, [x, top + 0.1 * heightM, 0], [x + 4.2 * size, top + 0.2 * heightM, 0.6 * size], 0.12 * size, kBlack);
}

/** A flag on a staff at the stern, both sides of it. */
function addFlag(builder: MeshBuilder, foot: Point, highM: number, paint: Paint): void {
  const [x, y] = foot;
  const tip: Point = [x - 0.25 * highM, y + highM, 0];
  addRod(builder, [x, y, 0], tip, 0.012 * highM + 0.003, kSteel);
  const at = (out: number, up: number): Point => [x - 0.25 * highM * up - 0.62 * highM * out, y + highM * (up - 0.16 * out), 0.05 * highM * Math.sin(5 * out)];
  const columns = [1, 0.75, 0.5, 0.25, 0];
  const rows = [0.56, 0.97].map((up) => columns.map((out) => at(out, up)));
  builder.grid(rows, paint);
  builder.grid(rows.map((row) => [...row].reverse()), paint);
}

function fitDinghy(builder: MeshBuilder, lines: HullLines, livery: Livery, { isFine }: Detail): BoatLamp[] {
  const { heightM, beamM } = lines.boat;
  const seatM = 0.2 * heightM;
  for (const [along, wide] of [[0.14, 0.13], [0.43, 0.09], [0.7, 0.09]] as const) addThwart(builder, lines, along, wide, seatM, livery.gunwale);
  addMotor(builder, lines);
  // A pair of oars along the sides, on the thwarts.
  for (const side of [-1, 1]) {
    const z = side * 0.24 * beamM;
    const y = seatM + 0.035 * heightM;
    addRod(builder, [lines.xM(0.2, y), y, z], [lines.xM(0.72, y), y, 0.86 * z], 0.016 * beamM, kCanvas);
    addPlate(builder, [[lines.xM(0.68, y), y + 0.02 * heightM, 0.86 * z - 0.05 * beamM], [lines.xM(0.68, y), y + 0.02 * heightM, 0.86 * z + 0.05 * beamM], [lines.xM(0.8, y), y + 0.02 * heightM, 0.86 * z + 0.04 * beamM], [lines.xM(0.8, y), y + 0.02 * heightM, 0.86 * z - 0.04 * beamM]], 0.02 * heightM, kCanvas);
  }
  addPerson(builder, [lines.xM(0.15, seatM), seatM + 0.035 * heightM, 0], kSeatedBeams * beamM, true, isFine);
  const bowM = lines.sheerM(0.93);
  const half = lines.halfM(0.93, bowM);
  const staff: Point = [lines.xM(0.04, heightM), lines.sheerM(0.04), 0.3 * beamM];
  addRod(builder, staff, [staff[0], staff[1] + 0.75 * heightM, staff[2]], 0.012 * beamM, kSteel);
  return [
    { at: [lines.xM(0.93, bowM), bowM + 0.05 * heightM, -half], kind: "port" },
    { at: [lines.xM(0.93, bowM), bowM + 0.05 * heightM, half], kind: "starboard" },
    { at: [staff[0], staff[1] + 0.8 * heightM, staff[2]], kind: "allRound" },
  ];
}

/** A house with sloping sides and a window in each of its faces; the front leans by `lean` (positive: forward, as on tugs). */
interface House {
  /** From its back to its front along the hull [m]. */
  backM: number;
  frontM: number;
  halfM: number;
  lowM: number;
  highM: number;
  lean: number;
  /** Windows in each side and in the front. */
  panesCount: number;
  /** Height of the windows' lower and upper edge, as shares. */
  sill: number;
  lintel: number;
  roofM: number;
}

function addHouse(builder: MeshBuilder, house: House, livery: Livery, deepM: number, eavesM: number): void {
  const { backM, frontM, halfM, lowM, highM, lean, panesCount, sill, lintel, roofM } = house;
  const cut = 0.2 * halfM;
  const tallM = highM - lowM;
  // Corners are cut off, so that the house has eight faces. Counter-clockwise seen from above.
  const ring = (yM: number, out = 0): Point[] => {
    const up = (yM - lowM) / tallM;
    const wide = halfM * (1 - 0.1 * up) + out;
    const [front, back] = [frontM + lean * tallM * up + out, backM + 0.06 * tallM * up - out];
    return [[back, yM, -wide + cut], [back, yM, wide - cut], [back + cut, yM, wide], [front - cut, yM, wide], [front, yM, wide - cut], [front, yM, -wide + cut], [front - cut, yM, -wide], [back + cut, yM, -wide]];
  };
  const [foot, low, high] = [ring(lowM), ring(lowM + sill * tallM), ring(lowM + lintel * tallM)];
  const top = ring(highM);
  for (let n = 0; n < 8; ++n) {
    const next = (n + 1) % 8;
    // Darker at the deck and under the eaves.
    builder.grid([[foot[n]!, foot[next]!], [low[n]!, low[next]!]], (row) => shaded(livery.house, row === 0 ? 0.6 : 1));
    builder.quad(high[n]!, high[next]!, top[next]!, top[n]!, shaded(livery.house, 0.75));
    const isSide = n === 2 || n === 6;
    const panes = isSide || n === 4 ? panesCount : 1;
    for (let pane = 0; pane < panes; ++pane) {
      const at = (row: readonly Point[], share: number): Point => [0, 1, 2].map((k) => row[n]![k]! + (row[next]![k]! - row[n]![k]!) * share) as unknown as Point;
      const [a, b] = [pane / panes, (pane + 1) / panes];
      addWindow(builder, [at(low, a), at(low, b), at(high, b), at(high, a)], { side: 0.09, low: 0.04, high: 0.04 }, deepM, livery.house, kGlass, kBlack);
    }
  }
  // A roof that stands out all round, with a camber.
  const eaves = ring(highM, eavesM);
  const edge = eaves.map(([x, y, z]): Point => [x, y + 0.6 * roofM, z]);
  const crown = ring(highM, -0.35 * halfM).map(([x, y, z]): Point => [x, y + roofM, z]);
  const closed = (row: readonly Point[]): Point[] => [...row, row[0]!];
  builder.grid([closed(top), closed(eaves)], shaded(livery.house, 0.6));
  builder.grid([closed(eaves), closed(edge)], livery.roof);
  const middle: Point = [(backM + frontM) / 2, highM + 1.15 * roofM, 0];
  builder.grid([closed(edge), closed(crown), closed(crown).map(() => middle)], livery.roof);
}

function fitLaunch(builder: MeshBuilder, lines: HullLines, livery: Livery, { isFine }: Detail): BoatLamp[] {
  const { heightM, beamM, lengthM } = lines.boat;
  const deckM = heightM / 2;
  // A wheelhouse, whose after end stands on the bulkhead of the cockpit, and a low cabin before it.
  const [backM, frontM, bowM] = [0.47, 0.61, 0.77].map((along) => lines.xM(along, deckM)) as [number, number, number];
  const halfM = 0.28 * beamM;
  const [lowM, highM] = [deckM - 0.02 * heightM, deckM + 0.56 * heightM];
  addHouse(builder, { backM, frontM, halfM, lowM, highM, lean: -0.16, panesCount: isFine ? 2 : 1, sill: 0.46, lintel: 0.9, roofM: 0.05 * heightM }, livery, isFine ? 0.014 * beamM : 0, 0.06 * beamM);
  const cabinM = deckM + 0.27 * heightM;
  if (isFine) addHouse(builder, { backM: frontM - 0.01 * lengthM, frontM: bowM, halfM: 0.92 * halfM, lowM, highM: cabinM, lean: -0.7, panesCount: 1, sill: 0.5, lintel: 0.8, roofM: 0.04 * heightM }, livery, 0, 0.01 * beamM);
  else builder.block((frontM + bowM) / 2, 0, { yM: lowM, halfX: 0.08 * lengthM, halfZ: 0.92 * halfM }, { yM: cabinM, halfX: 0.06 * lengthM, halfZ: 0.8 * halfM }, livery.house, livery.roof);
  // In the cockpit: the engine's box, fish boxes, somebody at the helm.
  const soleM = launchSoleM(lines);
  const onSole = (along: number, z: number, [halfX, tall, halfZ]: Point, paint: Paint, topPaint = paint): void => {
    const level = { halfX: halfX * lengthM, halfZ: halfZ * beamM };
    builder.block(lines.xM(along, soleM), z * beamM, { yM: soleM, ...level }, { yM: soleM + tall * heightM, ...level }, paint, topPaint);
  };
  onSole(0.3, 0, [0.055, 0.36, 0.14], shaded(livery.house, 0.8), livery.gunwale);
  addThwart(builder, lines, 0.1, 0.09, 0.14 * heightM, livery.gunwale);
  if (isFine) for (const [along, z, n] of [[0.2, -0.24, 0], [0.29, -0.3, 1], [0.19, 0.26, 1]] as const) onSole(along, z, [0.036, 0.17, 0.075], kFishBoxes[n]!, kCanvas);
  addPerson(builder, [backM - 0.075 * lengthM, soleM, 0.13 * beamM], kPersonBeams * beamM, false, isFine);
  const sternM = lines.sheerM(0.03);
  addFlag(builder, [lines.xM(0.03, sternM) + 0.02 * lengthM, sternM, 0], 0.55 * heightM, livery.flag);
  const mastX = backM + 0.04 * lengthM;
  const mastM = highM + 0.6 * heightM;
  addRod(builder, [mastX, highM, 0], [mastX, mastM, 0], 0.016 * beamM, livery.gunwale, 5, 0.009 * beamM);
  if (isFine) {
    addRailing(builder, lines, 0.72, 0.985, 0.2 * heightM, 5, 0.9);
    addRigging(builder, lines, [mastX, mastM, 0]);
    addRod(builder, [backM + 0.03 * lengthM, highM, -0.8 * halfM], [backM - 0.04 * lengthM, mastM, -0.9 * halfM], 0.008 * beamM, kBlack, 3);
    addFenders(builder, lines, [0.26, 0.56]);
  }
  const lampM = highM + 0.05 * heightM;
  return [
    { at: [frontM - 0.05 * lengthM, lampM, -0.8 * halfM], kind: "port" },
    { at: [frontM - 0.05 * lengthM, lampM, 0.8 * halfM], kind: "starboard" },
    { at: [mastX, mastM + 0.03 * heightM, 0], kind: "masthead" },
    { at: [lines.xM(0.01, sternM), sternM + 0.08 * heightM, -0.3 * beamM], kind: "stern" },
  ];
}

/** Adds stays from a mast's top to the stem, and to both sides abaft it. */
function addRigging(builder: MeshBuilder, lines: HullLines, top: Point): void {
  const radiusM = 0.004 * lines.boat.beamM;
  const stem = lines.outside(0.97, lines.sheerM(0.97));
  const side = lines.outside(0.36, lines.sheerM(0.36));
  for (const foot of [[stem[0], stem[1], 0], side, [side[0], side[1], -side[2]]] as Point[]) addRod(builder, foot, top, radiusM, kBlack, 3);
}

/** Adds fenders that hang on both sides, at positions along the hull. */
function addFenders(builder: MeshBuilder, lines: HullLines, places: readonly number[]): void {
  const radiusM = 0.038 * lines.boat.beamM;
  for (const along of places)
    for (const way of [-1, 1]) {
      const rimM = lines.sheerM(along);
      const [x, y, z] = lines.outside(along, rimM - 0.26 * lines.boat.heightM, 0.9 * radiusM);
      const turn = (up: number, radius: number): Turn => ({ yM: up * radiusM, radiusM: radius * radiusM, paint: kFender });
      addTurned(builder, [x, y, way * z], [turn(-3, 0), turn(-2.4, 0.9), turn(1.4, 1), turn(2.4, 0.25)], 5);
      addRod(builder, [x, y + 2.2 * radiusM, way * z], [x, rimM, way * lines.halfM(along, rimM)], 0.14 * radiusM, kRope, 3);
    }
}

/** Height of the floor boards in a launch's cockpit. */
export function launchSoleM({ boat }: HullLines): number {
  return -0.24 * boat.heightM;
}

/** A rail on posts along both sides, meeting at the bow. */
function addRailing(builder: MeshBuilder, lines: HullLines, from: number, to: number, highM: number, postsCount: number, inward: number): void {
  const rod = 0.009 * lines.boat.beamM;
  const at = (n: number, up: number, side: number): Point => {
    const along = from + ((to - from) * n) / (postsCount - 1);
    const sheerM = lines.sheerM(along);
    return [lines.xM(along, sheerM) - 0.01 * lines.boat.lengthM, sheerM + up * highM, side * inward * lines.halfM(along, sheerM)];
  };
  for (const side of [-1, 1]) {
    for (let n = 0; n < postsCount; ++n) addRod(builder, at(n, 0, side), at(n, 1, side), rod, kSteel);
    for (let n = 0; n + 1 < postsCount; ++n) addRod(builder, at(n, 1, side), at(n + 1, 1, side), rod, kSteel);
  }
  addRod(builder, at(postsCount - 1, 1, -1), at(postsCount - 1, 1, 1), rod, kSteel);
}

function fitCutter(builder: MeshBuilder, lines: HullLines, livery: Livery, { sidesCount, isFine }: Detail): BoatLamp[] {
  const { heightM, beamM, lengthM } = lines.boat;
  const deckM = heightM / 2;
  const houseM = Math.min(0.85 * heightM, 0.62 * beamM);
  const [backM, frontM] = [lines.xM(0.42, deckM), lines.xM(0.64, deckM)];
  const halfM = 0.29 * beamM;
  const highM = deckM + houseM;
  addHouse(builder, { backM, frontM, halfM, lowM: deckM - 0.03 * heightM, highM, lean: 0.1, panesCount: isFine ? 2 : 1, sill: 0.45, lintel: 0.9, roofM: 0.08 * houseM }, livery, isFine ? 0.012 * beamM : 0, 0.05 * beamM);
  // Engine casing with a funnel behind the house, in the boat's colour.
  const casingX = lines.xM(0.34, deckM);
  builder.block(casingX, 0, { yM: deckM - 0.02 * heightM, halfX: 0.075 * lengthM, halfZ: 0.19 * beamM }, { yM: deckM + 0.32 * houseM, halfX: 0.068 * lengthM, halfZ: 0.17 * beamM }, livery.house, livery.deck);
  const funnelM = 0.07 * beamM;
  addTurned(builder, [casingX, deckM + 0.32 * houseM, 0], [
    { yM: 0, radiusM: 1.05 * funnelM, paint: livery.side },
    { yM: 0.4 * houseM, radiusM: 0.9 * funnelM, paint: kBlack },
    { yM: 0.55 * houseM, radiusM: 0.86 * funnelM, paint: kBlack },
    { yM: 0.5 * houseM, radiusM: 0, paint: kBlack },
  ], sidesCount);
  // Mast with a yard on the roof.
  const mastX = backM + 0.3 * (frontM - backM);
  const mastM = highM + 0.95 * houseM;
  addRod(builder, [mastX, highM, 0], [mastX - 0.03 * lengthM, mastM, 0], 0.022 * beamM, livery.house, 6, 0.014 * beamM);
  addRod(builder, [mastX - 0.02 * lengthM, highM + 0.62 * houseM, -0.16 * beamM], [mastX - 0.02 * lengthM, highM + 0.62 * houseM, 0.16 * beamM], 0.01 * beamM, livery.house);
  // Towing bitts aft and on the foredeck.
  for (const along of [0.16, 0.83]) {
    const yM = lines.deckM(along);
    const x = lines.xM(along, yM);
    const wide = 0.09 * beamM;
    for (const z of [-wide, wide]) addRod(builder, [x, yM - 0.03 * heightM, z], [x, yM + 0.2 * heightM, z], 0.026 * beamM, kBlack, 6);
    addRod(builder, [x, yM + 0.12 * heightM, -1.8 * wide], [x, yM + 0.12 * heightM, 1.8 * wide], 0.018 * beamM, kBlack);
  }
  addPerson(builder, [lines.xM(0.24, deckM), lines.deckM(0.24), 0.2 * beamM], kPersonBeams * beamM, false, isFine);
  // A hatch before the house.
  const hatchX = lines.xM(0.73, deckM);
  const hatchM = lines.deckM(0.73);
  builder.block(hatchX, 0, { yM: hatchM - 0.05 * heightM, halfX: 0.035 * lengthM, halfZ: 0.1 * beamM }, { yM: hatchM + 0.09 * heightM, halfX: 0.032 * lengthM, halfZ: 0.09 * beamM }, livery.house, livery.gunwale);
  const sternM = lines.sheerM(0.02);
  addFlag(builder, [lines.xM(0.02, sternM) + 0.015 * lengthM, sternM, 0], 0.5 * heightM, livery.flag);
  if (isFine) {
    addRailing(builder, lines, 0.74, 0.98, 0.2 * heightM, 5, 0.94);
    addRigging(builder, lines, [mastX - 0.03 * lengthM, mastM, 0]);
    addFenders(builder, lines, [0.24, 0.6]);
  }
  const lampM = highM - 0.02 * houseM;
  return [
    { at: [backM + 0.6 * (frontM - backM), lampM, -1.07 * halfM], kind: "port" },
    { at: [backM + 0.6 * (frontM - backM), lampM, 1.07 * halfM], kind: "starboard" },
    { at: [mastX - 0.03 * lengthM, mastM + 0.04 * heightM, 0], kind: "masthead" },
    { at: [lines.xM(0.01, sternM), sternM + 0.09 * heightM, -0.2 * beamM], kind: "stern" },
  ];
}

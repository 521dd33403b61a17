// Objects in the water as triangles, of size 1 about their middle: x along, y up, z across, in the shapes of FloaterKind in scene.proto.
import type { BufferAttribute, BufferGeometry } from "three";

import type { FloaterKindName } from "../../../client/codec/floaters";
import { hash } from "../maths/random";
import { MeshBuilder, type Paint, type Point } from "../meshes/mesh_builder";
import { addPlate, addRod, addTurned, addWindow, type Turn } from "../meshes/shapes";

/** Paint of the object itself, which varies from one to another (floater_paints.ts), times a share; a red below 0 says so to the shader. */
const own = (share = 1, grain = 0): Paint => [-share, 0, 0, grain];
const kWoodGrain = 0.55;
const kGap: Paint = [0.035, 0.026, 0.018, 0.3];
const kIron: Paint = [0.13, 0.13, 0.14, 0.2];
const kWhite: Paint = [0.82, 0.82, 0.79, 0];
const kRope: Paint = [0.50, 0.40, 0.25, 0.4];
const kOrange: Paint = [0.80, 0.25, 0.02, 0];
const kCut: Paint = [0.34, 0.24, 0.13, 0.7];
const kHeart: Paint = [0.20, 0.13, 0.07, 0.7];
const kEye: Paint = [0.015, 0.015, 0.015, 0];

/** Sides of round things and rows of balls; the second for software renderers. */
interface Detail {
  sidesCount: number;
  rowsCount: number;
  isFine: boolean;
}
const kFull: Detail = { sidesCount: 18, rowsCount: 10, isFine: true };
const kPlain: Detail = { sidesCount: 12, rowsCount: 6, isFine: false };

const kMakers: Record<FloaterKindName, (detail: Detail) => BufferGeometry> = {
  crate: makeCrate,
  ball: makeBall,
  barrel: makeBarrel,
  plank: makePlank,
  duck: makeDuck,
  buoy: makeBuoy,
  raft: makeRaft,
  stone: makeStone,
};

export function makeFloaterGeometry(kind: FloaterKindName, plain: boolean): BufferGeometry {
  return kMakers[kind](plain ? kPlain : kFull);
}

/** The six faces of a cube: outward, rightward and upward axes as seen from outside. */
const kFaces: readonly (readonly [Point, Point, Point])[] = [
  [[1, 0, 0], [0, 0, -1], [0, 1, 0]], [[-1, 0, 0], [0, 0, 1], [0, 1, 0]],
  [[0, 0, 1], [1, 0, 0], [0, 1, 0]], [[0, 0, -1], [-1, 0, 0], [0, 1, 0]],
  [[0, 1, 0], [1, 0, 0], [0, 0, -1]], [[0, -1, 0], [1, 0, 0], [0, 0, 1]],
];

/** A frame of boards round each face, and planks set in between them. */
function makeCrate({ isFine }: Detail): BufferGeometry {
  const builder = new MeshBuilder();
  const [border, deep, planksCount] = [0.13, 0.035, isFine ? 4 : 2];
  kFaces.forEach(([out, right, up], face) => {
    const at = (outM: number, rightM: number, upM: number): Point => [0, 1, 2].map((k) => out[k]! * outM + right[k]! * rightM + up[k]! * upM) as unknown as Point;
    const corners = [at(0.5, -0.5, -0.5), at(0.5, 0.5, -0.5), at(0.5, 0.5, 0.5), at(0.5, -0.5, 0.5)] as const;
    addWindow(builder, corners, { side: border, low: border, high: border }, deep + 0.012, own(1, kWoodGrain), kGap);
    const inside = 0.5 - border;
    const wide = (2 * inside) / planksCount;
    for (let n = 0; n < planksCount; ++n) {
      const [low, high] = [-inside + n * wide + 0.008, -inside + (n + 1) * wide - 0.008];
      builder.quad(at(0.5 - deep, -inside, low), at(0.5 - deep, inside, low), at(0.5 - deep, inside, high), at(0.5 - deep, -inside, high), own(0.62 + 0.22 * hash(face, n, 3), kWoodGrain));
    }
    // A board from corner to corner of the four sides.
    if (isFine && face < 4) {
      const [end, half, lift] = [inside - 0.002, 0.075, 0.5 - 0.6 * deep];
      builder.quad(at(lift, -end, -end), at(lift, -end + half, -end), at(lift, end, end - half), at(lift, end, end), own(0.86, kWoodGrain));
      builder.quad(at(lift, -end, -end), at(lift, end, end), at(lift, end - half, end), at(lift, -end, -end + half), own(0.86, kWoodGrain));
    }
  });
  return builder.build();
}

/** Adds a body whose points are given by a latitude row (0 below, 1 above) and a turn round the upright axis (0..1). */
function addLobe(builder: MeshBuilder, rowsCount: number, columnsCount: number, at: (up: number, around: number) => Point, paint: (row: number, column: number) => Paint): void {
  const rows = Array.from({ length: rowsCount + 1 }, (_, row) => Array.from({ length: columnsCount + 1 }, (_, column) => at(row / rowsCount, (column % columnsCount) / columnsCount)));
  for (let column = 0; column < columnsCount; ++column)
    for (let row = 0; row < rowsCount; ++row)
      builder.grid([0, 1].map((r) => [0, 1].map((c) => rows[row + r]![column + c]!)), paint(row, column));
}

function onSphere(middle: Point, radii: Point): (up: number, around: number) => Point {
  return (up, around) => {
    const [polar, angle] = [Math.PI * (up - 0.5), -2 * Math.PI * around];
    const out = up === 0 || up === 1 ? 0 : Math.cos(polar);
    return [middle[0] + radii[0] * out * Math.cos(angle), middle[1] + radii[1] * Math.sin(polar), middle[2] + radii[2] * out * Math.sin(angle)];
  };
}

/** One normal for all vertices at a position, so that neighbouring panels meet smoothly. */
function smoothed(geometry: BufferGeometry): BufferGeometry {
  const positions = geometry.getAttribute("position") as BufferAttribute;
  const normals = geometry.getAttribute("normal") as BufferAttribute;
  const sums = new Map<string, [number, number, number]>();
  const keyOf = (n: number): string => [positions.getX(n), positions.getY(n), positions.getZ(n)].map((value) => Math.round(1e5 * value)).join();
  for (let n = 0; n < positions.count; ++n) {
    const sum = sums.get(keyOf(n)) ?? [0, 0, 0];
    sums.set(keyOf(n), [sum[0] + normals.getX(n), sum[1] + normals.getY(n), sum[2] + normals.getZ(n)]);
  }
  for (let n = 0; n < positions.count; ++n) {
    const [x, y, z] = sums.get(keyOf(n))!;
    const length = Math.hypot(x, y, z);
    if (length > 1e-6) normals.setXYZ(n, x / length, y / length, z / length);
  }
  return geometry;
}

/** Six panels, white and coloured in turn, with a cap at either pole. */
function makeBall({ sidesCount, rowsCount }: Detail): BufferGeometry {
  const builder = new MeshBuilder();
  const perPanel = sidesCount / 6;
  addLobe(builder, rowsCount, sidesCount, onSphere([0, 0, 0], [0.5, 0.5, 0.5]), (row, column) => (row === 0 || row === rowsCount - 1 ? own(0.55) : Math.floor(column / perPanel) % 2 === 0 ? own() : kWhite));
  return smoothed(builder.build());
}

/** Adds a body of revolution along x: as addTurned, lying. */
function addLying(builder: MeshBuilder, turns: readonly Turn[], sidesCount: number, y = 0, z = 0): void {
  const row = ({ yM, radiusM }: Turn): Point[] =>
    Array.from({ length: sidesCount + 1 }, (_, i) => {
      const angle = (2 * Math.PI * (i % sidesCount)) / sidesCount;
      return [yM, y + radiusM * Math.cos(angle), z + radiusM * Math.sin(angle)];
    });
  for (let n = 0; n + 1 < turns.length; ++n) builder.ring([row(turns[n]!), row(turns[n + 1]!)], turns[n]!.paint);
}

/** Bulging staves, four hoops, ends set in. */
function makeBarrel({ sidesCount }: Detail): BufferGeometry {
  const builder = new MeshBuilder();
  const radiusAt = (x: number): number => 0.33 - 0.055 * (2 * x) ** 2;
  const [wood, end] = [own(1, kWoodGrain), own(0.7, kWoodGrain)];
  const at = (x: number, paint: Paint, outM = 0): Turn => ({ yM: x, radiusM: radiusAt(x) + outM, paint });
  const hoop = (x: number): Turn[] => [at(x - 0.032, kIron), at(x - 0.032, kIron, 0.009), at(x + 0.032, kIron, 0.009), at(x + 0.032, wood)];
  addLying(builder, [
    { yM: -0.46, radiusM: 0, paint: end }, { yM: -0.46, radiusM: radiusAt(0.5) - 0.03, paint: wood }, { yM: -0.5, radiusM: radiusAt(0.5) - 0.03, paint: wood }, at(-0.5, wood),
    ...hoop(-0.42), ...hoop(-0.2), at(0, wood), ...hoop(0.2), ...hoop(0.42), at(0.5, wood),
    { yM: 0.5, radiusM: radiusAt(0.5) - 0.03, paint: wood }, { yM: 0.46, radiusM: radiusAt(0.5) - 0.03, paint: end }, { yM: 0.46, radiusM: 0, paint: end },
  ], sidesCount);
  // The bung.
  addRod(builder, [0, 0.32, 0], [0, 0.342, 0], 0.03, kGap, 6);
  return builder.build();
}

/** A board with a lighter end at either side and dark nails. */
function makePlank({ isFine }: Detail): BufferGeometry {
  const builder = new MeshBuilder();
  const [x, y, z] = [0.5, 0.04, 0.12];
  builder.block(0, 0, { yM: -y, halfX: x, halfZ: z }, { yM: y, halfX: x, halfZ: z }, own(0.9, kWoodGrain), own(1, kWoodGrain));
  builder.quad([-x, -y, -z], [x, -y, -z], [x, -y, z], [-x, -y, z], own(0.8, kWoodGrain));
  if (!isFine) return builder.build();
  const nail = 0.012;
  for (const end of [-0.42, 0.42]) for (const across of [-0.07, 0.07]) builder.block(end, across, { yM: y, halfX: nail, halfZ: nail }, { yM: y + 0.004, halfX: nail, halfZ: nail }, kIron);
  return builder.build();
}

/** Body with a tail that points up, head, beak and eyes. */
function makeDuck({ sidesCount, rowsCount }: Detail): BufferGeometry {
  const builder = new MeshBuilder();
  const body = onSphere([-0.06, -0.12, 0], [0.4, 0.27, 0.31]);
  addLobe(builder, rowsCount, sidesCount, (up, around) => {
    const [x, y, z] = body(up, around);
    // The tail is pulled back and up; the bottom is flat.
    const tail = Math.max(-(x + 0.16) / 0.3, 0) ** 2 * Math.max((y + 0.22) / 0.27, 0);
    return [x - 0.06 * tail, Math.max(y + 0.26 * tail, -0.36), z * (1 - 0.35 * Math.min(tail, 1))];
  }, () => own());
  addLobe(builder, rowsCount, sidesCount, onSphere([0.19, 0.25, 0], [0.205, 0.205, 0.2]), () => own());
  // The beak: flat, wide, a little open.
  for (const [y, tip] of [[0.235, 0.25], [0.19, 0.18]] as const) addLobe(builder, 4, 8, (up, around) => {
    const [x, high, z] = onSphere([0.39, y, 0], [0.1, 0.03, 0.095])(up, around);
    return [x, high + (x > 0.4 ? tip - y : 0), z];
  }, () => kOrange);
  for (const side of [-1, 1]) addLobe(builder, 4, 6, onSphere([0.315, 0.31, side * 0.125], [0.035, 0.04, 0.035]), () => kEye);
  // Wings.
  for (const side of [-1, 1]) addLobe(builder, 4, 8, onSphere([-0.12, -0.05, side * 0.245], [0.2, 0.1, 0.075]), () => own(0.88));
  return smoothed(builder.build());
}

/** A can in red and white bands, a tapered top with a ball. */
function makeBuoy({ sidesCount }: Detail): BufferGeometry {
  const builder = new MeshBuilder();
  const at = (yM: number, radiusM: number, paint: Paint): Turn => ({ yM, radiusM, paint });
  addTurned(builder, [0, 0, 0], [
    at(-0.5, 0, own(0.5)), at(-0.5, 0.2, own(0.5)), at(-0.43, 0.285, own()), at(-0.22, 0.3, own()), at(-0.22, 0.3, kWhite), at(-0.04, 0.3, kWhite), at(-0.04, 0.3, own()), at(0.1, 0.3, own()), at(0.15, 0.26, own()),
    at(0.15, 0.15, kWhite), at(0.26, 0.11, own()), at(0.36, 0.075, own()), at(0.36, 0.03, kIron), at(0.4, 0.03, own()),
  ], sidesCount);
  addTurned(builder, [0, 0, 0], [at(0.385, 0, own()), at(0.395, 0.05, own()), at(0.43, 0.068, own()), at(0.47, 0.05, own()), at(0.5, 0, own())], Math.max(sidesCount - 6, 6));
  return builder.build();
}

/** Six logs of unequal length, two boards across, lashed with rope. */
function makeRaft({ isFine }: Detail): BufferGeometry {
  const builder = new MeshBuilder();
  const logsCount = 6;
  const radius = 0.35 / logsCount;
  const sides = isFine ? 12 : 6;
  for (let n = 0; n < logsCount; ++n) {
    const z = -0.35 + radius * (2 * n + 1);
    const half = 0.5 - 0.035 * hash(n, 1, 5);
    // Trunks are uneven in thickness and colour; a cut has pale wood round a dark heart.
    const trunk = Array.from({ length: isFine ? 7 : 2 }, (_, k, of = isFine ? 6 : 1): Turn => ({ yM: half * ((2 * k) / of - 1), radiusM: radius * (0.86 + 0.16 * hash(n, k, 3)), paint: own(0.5 + 0.4 * hash(n, k, 5), 0.75) }));
    const cut = (end: Turn, share: number, paint: Paint): Turn => ({ ...end, radiusM: share * end.radiusM, paint });
    const [first, last] = [trunk[0]!, trunk.at(-1)!];
    addLying(builder, [cut(first, 0, kHeart), cut(first, 0.45, kCut), ...trunk.slice(0, -1), cut(last, 1, kCut), cut(last, 0.45, kHeart), cut(last, 0, kHeart)], sides, 0, z);
  }
  for (const x of [-0.32, 0.32]) {
    addPlate(builder, [[x - 0.05, 0.082, 0.35], [x + 0.05, 0.082, 0.35], [x + 0.05, 0.082, -0.35], [x - 0.05, 0.082, -0.35]], 0.03, own(0.9, kWoodGrain));
    if (isFine) for (const z of [-0.233, 0, 0.233]) builder.block(x, z, { yM: 0.05, halfX: 0.066, halfZ: 0.014 }, { yM: 0.09, halfX: 0.062, halfZ: 0.014 }, kRope);
  }
  return builder.build();
}

/** A ball with hollows and bumps, worn round. */
function makeStone({ sidesCount, rowsCount }: Detail): BufferGeometry {
  const builder = new MeshBuilder();
  const sphere = onSphere([0, 0, 0], [0.5, 0.5, 0.5]);
  addLobe(builder, rowsCount, sidesCount, (up, around) => {
    const [x, y, z] = sphere(up, around);
    const rough = 1 + 0.07 * Math.sin(5 * x + 1.3) * Math.cos(6 * z - 0.4) + 0.05 * Math.sin(9 * y + 4 * x);
    return [x * rough, 0.88 * y * rough, 0.95 * z * rough];
  }, (row, column) => own(0.9 + 0.2 * hash(row, column, 9), 0.9));
  return smoothed(builder.build());
}

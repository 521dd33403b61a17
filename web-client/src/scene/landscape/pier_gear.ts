// What a working pier carries, in the axes of its wall: tyres and ladders on both sides, a railing along one edge, a crane, pots for lobsters, and
// people. The plain tiers have none of it.
import type { BreakwaterInfo } from "../../../client/codec/scene_info";
import { hash } from "../maths/random";
import type { MeshBuilder, Paint, Point } from "../meshes/mesh_builder";
import { addPerson } from "../meshes/person";
import { addRod } from "../meshes/shapes";

const kTyre: Paint = [0.022, 0.022, 0.024, 0.6];
const kIron: Paint = [0.11, 0.075, 0.055, 0.6];
const kRail: Paint = [0.36, 0.37, 0.36, 0.2];
const kCrane: Paint = [0.50, 0.33, 0.06, 0.3];
const kNets: readonly Paint[] = [[0.06, 0.12, 0.13, 0.9], [0.16, 0.12, 0.07, 0.9], [0.10, 0.13, 0.08, 0.9]];
const kJackets: readonly Paint[] = [[0.42, 0.30, 0.05, 0.6], [0.07, 0.11, 0.20, 0.6], [0.35, 0.07, 0.05, 0.6]];

export function addPierGear(builder: MeshBuilder, { lengthM, widthM, heightM }: BreakwaterInfo): void {
  const halfZ = widthM / 2;
  const at = (along: number, yM: number, z: number): Point => [along * lengthM, yM, z * widthM];
  const count = Math.min(Math.round(lengthM / (0.8 * widthM)), 24);
  for (const side of [-1, 1])
    for (let n = 0; n < count; ++n) {
      const xM = lengthM * ((n + 0.5) / count - 0.5);
      if (n % 4 === 1) addLadder(builder, xM, side * (halfZ + 0.03 * widthM), heightM, widthM);
      else addTyre(builder, [xM, heightM * (0.45 + 0.1 * hash(n, side, 91)), side * halfZ], 0.1 * widthM, side);
    }
  // The railing, up to where the light stands.
  const posts = 2 * count;
  const post = (n: number, up: number): Point => at((n / posts - 0.5) * (1 - (1.2 * widthM) / lengthM) - (0.6 * widthM) / lengthM + 0.01, heightM + up * 0.26 * widthM, 0.44);
  for (let n = 0; n < posts; ++n) {
    addRod(builder, post(n, 0), post(n, 1), 0.011 * widthM, kRail, 3);
    for (const up of [0.5, 1]) addRod(builder, post(n, up), post(n + 1, up), 0.009 * widthM, kRail, 3);
  }
  // The crane: a mast on a foot, its jib along the edge, the rope with its hook.
  const mast = (up: number): Point => at(-0.2, heightM + up * widthM, 0.2);
  const [tip, hook] = [at(-0.32, heightM + 1.25 * widthM, 0.45), at(-0.32, heightM + 0.2 * widthM, 0.45)];
  addRod(builder, mast(0), mast(0.3), 0.11 * widthM, kRail, 8);
  addRod(builder, mast(0.3), mast(1.1), 0.055 * widthM, kCrane, 8);
  addRod(builder, mast(0.45), tip, 0.045 * widthM, kCrane, 4, 0.025 * widthM);
  for (const [from, to] of [[mast(1.08), tip], [tip, hook]] as const) addRod(builder, from, to, 0.008 * widthM, kTyre, 3);
  addRod(builder, hook, at(-0.32, heightM + 0.1 * widthM, 0.45), 0.03 * widthM, kTyre, 5);
  // Heaps of six pots: three, two and one over each other.
  for (let n = 0; n < 18; ++n) {
    const [tier, across] = ([[0, 0], [0, 1], [0, 2], [1, 0.5], [1, 1.5], [2, 1]] as const)[n % 6]!;
    const potM = 0.13 * widthM;
    addPot(builder, at(0, heightM + 0.9 * tier * potM, 0.3), potM, [-0.12, 0.14, 0.21][Math.floor(n / 6)]! * lengthM + 1.25 * across * potM, kNets[Math.floor(4 * hash(n, 1, 93)) % 3]!);
  }
  for (const [n, along, z] of [[0, 0.03, 0.2], [1, 0.06, 0.26], [2, -0.25, 0.1]] as const) addPerson(builder, at(along, heightM, z), 0.4 * widthM, false, true, kJackets[n]);
}

function addLadder(builder: MeshBuilder, xM: number, zM: number, heightM: number, widthM: number): void {
  const wideM = 0.09 * widthM;
  for (const x of [xM - wideM, xM + wideM]) addRod(builder, [x, -0.2 * heightM, zM], [x, 1.16 * heightM, zM], 0.014 * widthM, kIron, 4);
  for (let up = 0; up <= heightM; up += Math.max(0.11 * widthM, heightM / 9)) addRod(builder, [xM - wideM, up, zM], [xM + wideM, up, zM], 0.01 * widthM, kIron, 3);
}

/** A tyre that hangs on a chain before a wall. */
function addTyre(builder: MeshBuilder, [xM, yM, zM]: Point, radiusM: number, side: number): void {
  const rows = [[1, 0], [0.95, 0.6], [0.55, 0.6], [0.5, 0]].map(([radius, out]) =>
    Array.from({ length: 10 }, (_, i): Point => {
      const angle = (side * 2 * Math.PI * (i % 9)) / 9;
      return [xM + radius! * radiusM * Math.cos(angle), yM + radius! * radiusM * Math.sin(angle), zM + side * out! * radiusM];
    }),
  );
  builder.ring(rows, kTyre);
  addRod(builder, [xM, yM + 0.9 * radiusM, zM + 0.1 * side * radiusM], [xM, yM + 3 * radiusM, zM + 0.1 * side * radiusM], 0.1 * radiusM, kIron, 3);
}

/** A trap with a round back, in its net. */
function addPot(builder: MeshBuilder, [, yM, zM]: Point, sizeM: number, xM: number, net: Paint): void {
  const arc = Array.from({ length: 6 }, (_, i): Point => [0, sizeM * Math.sin((Math.PI * i) / 5), 0.55 * sizeM * Math.cos((Math.PI * i) / 5)]);
  const row = (x: number): Point[] => arc.map(([, y, z]) => [xM + x * sizeM, yM + y, zM + z]);
  builder.grid([row(0.6), row(-0.6)], net);
  for (const x of [0.6, -0.6]) {
    const [edge, middle] = [row(x), row(x).map((): Point => [xM + x * sizeM, yM, zM])];
    builder.grid(x > 0 ? [middle, edge] : [edge, middle], kTyre);
  }
}

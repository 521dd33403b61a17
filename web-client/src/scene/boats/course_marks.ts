// The course on the water: marks as tall buoys, the next one of one's own boat in another colour, and goals as frames of coloured floats.
// The server does not know their meshes: boats pass through. The vertex shader moves them with the drawn water (FLOATS in solid.vert).
import { Group, Mesh, type BufferGeometry, type RawShaderMaterial } from "three";

import type { CourseGoal, CourseInfo, CourseMark } from "../../../client/codec/course";
import type { GameInfo } from "../../../client/codec/game";
import { clamp } from "../maths/interpolate";
import { castsShadow } from "../meshes/casters";
import { MeshBuilder, type Paint } from "../meshes/mesh_builder";
import { addTurned } from "../meshes/shapes";

/** A mark's buoy: its radius over the distance in which it counts as passed, and the bounds of it [m]; its height in radii. */
const kMarkShare = 0.12;
const kMarkLimitsM = [0.15, 1] as const;
const kMarkRadii = 3.4;
/** Floats of a goal: radius over its longer side, and its bounds [m]; most floats along a side. */
const kFloatShare = 0.028;
const kFloatLimitsM = [0.08, 0.4] as const;
const kFloatsMax = 9;

const kMark: Paint = [0.72, 0.16, 0.02, 0];
const kNext: Paint = [0.95, 0.74, 0.02, 0];
const kBand: Paint = [0.86, 0.87, 0.85, 0];
const kTeams: Record<"red" | "blue", Paint> = { red: [0.75, 0.06, 0.07, 0], blue: [0.05, 0.20, 0.78, 0] };

/** Height of a mark's top over the water [m]. */
export function markTopM(mark: CourseMark): number {
  return kMarkRadii * markRadiusM(mark);
}

function markRadiusM({ radiusM }: CourseMark): number {
  return clamp(kMarkShare * radiusM, ...kMarkLimitsM);
}

/** Returns where the floats of a goal's frame are: at its corners, and evenly between them. */
export function floatPlaces({ xM, zM, lengthM, widthM }: CourseGoal): { xM: number; zM: number }[] {
  const spacingM = Math.max(lengthM, widthM) / kFloatsMax;
  const [alongX, alongZ] = [lengthM, widthM].map((sideM) => Math.max(Math.round(sideM / spacingM), 1)) as [number, number];
  const at = (x: number, z: number): { xM: number; zM: number } => ({ xM: xM + (x - 0.5) * lengthM, zM: zM + (z - 0.5) * widthM });
  const x = Array.from({ length: alongX }, (_, n) => [at(n / alongX, 0), at((n + 1) / alongX, 1)]).flat();
  const z = Array.from({ length: alongZ }, (_, n) => [at(1, n / alongZ), at(0, (n + 1) / alongZ)]).flat();
  return [...x, ...z];
}

function makeMark(mark: CourseMark, isNext: boolean, plain: boolean): BufferGeometry {
  const r = markRadiusM(mark);
  const paint = isNext ? kNext : kMark;
  const at = (up: number, radius: number, its: Paint) => ({ yM: up * r, radiusM: radius * r, paint: its });
  const builder = new MeshBuilder();
  addTurned(builder, [0, 0, 0], [at(-0.9, 0, paint), at(-0.8, 0.8, paint), at(0, 1, paint), at(1.1, 0.94, kBand), at(1.8, 0.86, paint), at(2.9, 0.66, paint), at(3.2, 0.54, paint), at(3.34, 0.36, paint), at(kMarkRadii, 0, paint)], plain ? 8 : 18);
  return builder.build();
}

function makeFloat(radiusM: number, paint: Paint, plain: boolean): BufferGeometry {
  const builder = new MeshBuilder();
  const rows = [-1, -0.7, 0, 0.7, 1].map((up) => ({ yM: (up + 0.35) * radiusM, radiusM: radiusM * Math.sqrt(1 - up * up), paint }));
  addTurned(builder, [0, 0, 0], rows, plain ? 6 : 12);
  return builder.build();
}

export class CourseMarks {
  readonly group = new Group();
  private readonly marks: Mesh[];
  private readonly goals: Mesh[] = [];
  private readonly geometries: BufferGeometry[] = [];
  private next: number | undefined;

  /** The caller disposes `material`, which has the define FLOATS. */
  constructor(
    private readonly course: CourseInfo,
    private readonly material: RawShaderMaterial,
    private readonly plain: boolean,
  ) {
    this.marks = course.marks.map((mark) => this.add(makeMark(mark, false, plain), mark));
    for (const team of ["red", "blue"] as const) {
      const goal = course.goals?.[team];
      if (!goal) continue;
      const radiusM = clamp(kFloatShare * Math.max(goal.lengthM, goal.widthM), ...kFloatLimitsM);
      const [own, white] = [kTeams[team], kBand].map((paint) => makeFloat(radiusM, paint, plain)) as [BufferGeometry, BufferGeometry];
      this.geometries.push(own, white);
      this.goals.push(...floatPlaces(goal).map((place, n) => this.add(n % 4 === 3 ? white : own, place)));
    }
  }

  /** Shows what belongs to a game, without one everything, and highlights a mark of the course. */
  setGame(kind: GameInfo["kind"] | undefined, next: number | undefined): void {
    for (const mark of this.marks) mark.visible = kind !== "ball";
    for (const float of this.goals) float.visible = kind !== "race";
    if (next === this.next) return;
    const before = this.next;
    this.next = next;
    for (const n of [before, next]) {
      const mesh = n === undefined ? undefined : this.marks[n];
      if (!mesh) continue;
      mesh.geometry.dispose();
      mesh.geometry = makeMark(this.course.marks[n!]!, n === next, this.plain);
    }
  }

  dispose(): void {
    for (const { geometry } of this.marks) geometry.dispose();
    for (const geometry of this.geometries) geometry.dispose();
  }

  private add(geometry: BufferGeometry, { xM, zM }: { xM: number; zM: number }): Mesh {
    const mesh = new Mesh(geometry, this.material);
    mesh.position.set(xM, 0, zM);
    mesh.frustumCulled = false;
    castsShadow(mesh, "float");
    this.group.add(mesh);
    return mesh;
  }
}

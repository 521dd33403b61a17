// Buoys off the ends of breakwaters, in an open sea. Decoration: the server does not know them; boats push them
// aside. Their positions follow from the scene alone; the vertex shader moves them with the drawn water (shaders/solid.vert, FLOATS).
import { Group, Mesh, type BufferGeometry, type RawShaderMaterial } from "three";

import type { GreetingInfo } from "../../../client/codec/greeting";
import { kSideNames, type BreakwaterInfo } from "../../../client/codec/scene_info";
import { clearanceM } from "../landscape/clearance";
import { bedOf, depthAtM, insideM } from "../landscape/terrain";
import { kLampColors, type Lamps } from "../light/lamps";
import { clamp } from "../maths/interpolate";
import { castsShadow } from "../meshes/casters";
import { MeshBuilder, type Paint } from "../meshes/mesh_builder";
import { addRod, addTurned } from "../meshes/shapes";

const kBuoysMax = 8;
/** Distance from the end of a breakwater, in widths of it, tried in this order. */
const kOffWidths = [1.6, 2.6, 3.8];
/** Least distances, in widths: to obstacles, to sides, between buoys. */
const kClearWidths = { obstacle: 0.9, side: 1.5, buoy: 3 };
/** The water is at least this deep, as a share of the scene's depth. */
const kLeastDepths = 0.6;
/** A buoy's radius as a share of the breakwater's width, and its bounds [m]. */
const kRadiusWidths = 0.17;
const kRadiusLimitsM = [0.08, 0.6] as const;
/** Lights: a flash of this length, once in this time. */
const kFlashS = 0.7;
const kFlashEveryS = 3;

const kPaints: Record<BuoyPlace["kind"], Paint> = { red: [0.66, 0.05, 0.035, 0], green: [0.03, 0.34, 0.14, 0] };
const kLampPaints: Record<BuoyPlace["kind"], Paint> = { red: [0.8, 0.08, 0.05, -1], green: [0.08, 0.7, 0.25, -1] };
const kWeed: Paint = [0.09, 0.11, 0.05, 0.6];
const kSteel: Paint = [0.30, 0.31, 0.32, 0];

interface BuoyPlace {
  kind: "red" | "green";
  xM: number;
  zM: number;
  radiusM: number;
}

type BuoyScene = Pick<GreetingInfo, "sideM" | "widthM" | "waterExtents" | "beaches" | "obstacles" | "wave" | "setting">;

/** Returns the positions of the buoys: off both ends of each breakwater, where there is room and depth, and outside of absorbing layers. */
export function buoyPlaces(greeting: BuoyScene): BuoyPlace[] {
  const { wave, obstacles, setting } = greeting;
  if (!wave || setting !== "openSea") return [];
  const bed = bedOf(greeting);
  const isFree = (xM: number, zM: number, widthM: number, found: readonly BuoyPlace[]): boolean =>
    kSideNames.every((side) => insideM(side, greeting, xM, zM) > kClearWidths.side * widthM + (wave.sides[side] === "open" ? wave.spongeWidthM : 0)) &&
    depthAtM(bed, xM, zM) >= kLeastDepths * bed.depthM &&
    obstacles.every((obstacle) => clearanceM(obstacle, xM, zM) > kClearWidths.obstacle * widthM) &&
    found.every((other) => Math.hypot(xM - other.xM, zM - other.zM) > kClearWidths.buoy * widthM);
  const found: BuoyPlace[] = [];
  for (const wall of obstacles.filter((each): each is BreakwaterInfo => each.shape === "breakwater")) {
    const radiusM = clamp(kRadiusWidths * wall.widthM, kRadiusLimitsM[0], kRadiusLimitsM[1]);
    for (const end of [1, -1])
      for (const off of kOffWidths) {
        const alongM = end * (wall.lengthM / 2 + off * wall.widthM);
        const xM = wall.xM + alongM * Math.cos(wall.headingRad);
        const zM = wall.zM + alongM * Math.sin(wall.headingRad);
        if (found.length >= kBuoysMax || !isFree(xM, zM, wall.widthM, found)) continue;
        found.push({ kind: found.length % 2 === 0 ? "red" : "green", xM, zM, radiusM });
        break;
      }
  }
  return found;
}

/** A boat from above: its length is along the heading. */
export interface HullPlan {
  xM: number;
  zM: number;
  headingRad: number;
  lengthM: number;
  beamM: number;
}

/** Returns where boats push a buoy: across each hull that reaches it, out of the ellipse around hull and buoy. Far from boats it is at its position. */
export function pushedAside({ xM, zM, radiusM }: Pick<BuoyPlace, "xM" | "zM" | "radiusM">, hulls: readonly HullPlan[]): [xM: number, zM: number] {
  let [x, z] = [xM, zM];
  for (const hull of hulls) {
    const [cos, sin] = [Math.cos(hull.headingRad), Math.sin(hull.headingRad)];
    const along = ((x - hull.xM) * cos + (z - hull.zM) * sin) / (hull.lengthM / 2 + radiusM);
    if (Math.abs(along) >= 1) continue;
    const acrossM = (z - hull.zM) * cos - (x - hull.xM) * sin;
    const leastM = (hull.beamM / 2 + radiusM) * Math.sqrt(1 - along * along);
    const outM = (acrossM < 0 ? -leastM : leastM) - acrossM;
    if (Math.abs(acrossM) >= leastM) continue;
    x -= sin * outM;
    z += cos * outM;
  }
  return [x, z];
}

/** Height of the lamp over the water, in radii. */
const kLampRadii = 3.5;

/** Returns a buoy, floating at y = 0: a can with a square topmark (red), or a cone with a pointed one (green). */
export function makeBuoyGeometry({ kind, radiusM: r }: Pick<BuoyPlace, "kind" | "radiusM">, plain: boolean): BufferGeometry {
  const builder = new MeshBuilder();
  const paint = kPaints[kind];
  const sides = plain ? 8 : 16;
  const at = (up: number, radius: number, its: Paint) => ({ yM: up * r, radiusM: radius * r, paint: its });
  addTurned(builder, [0, 0, 0], [
    at(-1.1, 0, kWeed), at(-1, 0.5, kWeed), at(-0.7, 0.92, kWeed), at(0.06, 1, paint), at(0.34, 1, paint), at(0.46, 0.9, paint),
    ...(kind === "red" ? [at(0.46, 0.42, paint), at(2.2, 0.34, paint)] : [at(0.46, 0.72, paint), at(2.2, 0.2, paint)]),
    at(2.2, 0, paint),
  ], sides);
  for (const turn of [0, 1, 2]) {
    const angle = (2 * Math.PI * turn) / 3;
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    addRod(builder, [0.8 * r * c, 0.44 * r, 0.8 * r * s], [0.16 * r * c, 2.6 * r, 0.16 * r * s], 0.05 * r, kSteel, plain ? 3 : 5);
  }
  addTurned(builder, [0, 0, 0], [
    ...(kind === "red" ? [at(2.5, 0, paint), at(2.5, 0.36, paint), at(3.1, 0.36, paint)] : [at(2.5, 0, paint), at(2.5, 0.42, paint), at(3.15, 0.04, paint)]),
    at(3.2, 0.14, kSteel), at(3.3, 0.16, kLampPaints[kind]), at(3.68, 0.14, kSteel), at(3.78, 0, kSteel),
  ], plain ? 6 : 12);
  return builder.build();
}

export class Buoys {
  readonly group = new Group();
  private readonly geometries: BufferGeometry[] = [];

  /** The caller disposes `material`, which has the define FLOATS. */
  constructor(
    private readonly places: readonly BuoyPlace[],
    material: RawShaderMaterial,
    plain: boolean,
  ) {
    for (const place of places) {
      const geometry = makeBuoyGeometry(place, plain);
      const mesh = new Mesh(geometry, material);
      mesh.position.set(place.xM, 0, place.zM);
      mesh.frustumCulled = false;
      castsShadow(mesh, "float");
      this.geometries.push(geometry);
      this.group.add(mesh);
    }
  }

  /** Moves them out of the way of the boats. */
  pushAside(hulls: readonly HullPlan[]): void {
    this.places.forEach((place, n) => {
      const [xM, zM] = pushedAside(place, hulls);
      this.group.children[n]!.position.set(xM, 0, zM);
    });
  }

  /** Adds their lights, which flash one after the other by the scene's time. */
  collectLamps(lamps: Lamps, shownS: number): void {
    this.places.forEach(({ kind, radiusM }, n) => {
      const { x: xM, z: zM } = this.group.children[n]!.position;
      const phaseS = (shownS + 0.37 * n * kFlashEveryS) % kFlashEveryS;
      const share = clamp(3 - 6 * Math.abs(phaseS / kFlashS - 0.5), 0, 1);
      lamps.add(xM, kLampRadii * radiusM, zM, 1.6 * radiusM, kLampColors[kind], share, true);
    });
  }

  dispose(): void {
    for (const geometry of this.geometries) geometry.dispose();
  }
}

// The bed with its beaches, the rocks and the breakwaters. Built once per scene.
import { Group, Mesh, Vector3, type BufferGeometry, type RawShaderMaterial } from "three";

import type { ObstacleInfo } from "../../../client/codec/scene_info";
import { kLampColors, type Lamps } from "../light/lamps";
import { castsShadow } from "../meshes/casters";
import { MeshBuilder, type Paint, type Point } from "../meshes/mesh_builder";
import { makeBreakwater, type LightKind } from "./breakwater_mesh";
import { bedPaint, kTankTile } from "./paints";
import { makeRockGeometry } from "./rock_mesh";
import { makeSkerry } from "./skerry";
import { depthAtM, groundExtent, groundHeightM, longSideM, type Bed } from "./terrain";

const kCut: Paint = [0.74, 0.58, 0.40, 0.8];
/** The floor around the water is lowered by this share of the side, to avoid z-fighting with the bed. */
const kFloorDropSides = 0.002;

/**
 * Returns the bed as a grid with vertical faces on all sides, down to the floor; `cellsCount`: along its longer side. `tileSides`: of a tank,
 * side of its tiles in sides of the water (tiles.frag).
 */
export function makeGroundGeometry(bed: Bed, cellsCount: number, tileSides?: number): BufferGeometry {
  const { minXM, maxXM, minZM, maxZM } = groundExtent(bed);
  const floorM = -bed.depthM - kFloorDropSides * longSideM(bed);
  const cellM = Math.max(maxXM - minXM, maxZM - minZM) / cellsCount;
  const lines = (fromM: number, toM: number): number[] => {
    const count = Math.ceil(Math.abs(toM - fromM) / cellM - 1e-6);
    return Array.from({ length: count + 1 }, (_, n) => fromM + ((toM - fromM) * n) / count);
  };
  const columns = lines(minXM, maxXM);
  const at = (xM: number, zM: number): Point => [xM, groundHeightM(bed, xM, zM), zM];
  // From near to far: rows go up and columns go right, seen from above.
  const rows = lines(maxZM, minZM).map((zM) => columns.map((xM) => at(xM, zM)));
  const builder = new MeshBuilder();
  const tile: Paint | undefined = tileSides ? [...kTankTile, tileSides] : undefined;
  builder.grid(rows, tile ?? ((row, column) => bedPaint(rows[row]![column]![1], bed.depthM)));
  const down = ([xM, , zM]: Point): Point => [xM, floorM, zM];
  const edges = [rows[0]!, [...rows.at(-1)!].reverse(), rows.map((row) => row.at(-1)!), rows.map((row) => row[0]!).reverse()];
  for (const edge of edges) builder.grid([edge.map(down), edge], tile ?? kCut);
  return builder.build();
}

/** A turn of the lighthouse's two beams. */
const kTurnS = 9;
/** Reach of a beam and radius of its end, in heights of the lamp over the water. */
const kBeamHeights = 7;
const kBeamEndHeights = 0.75;

interface Light {
  kind: LightKind;
  atM: Vector3;
}

/** Returns the heading of a lighthouse's beam, the same for everybody at a time of the scene. */
export function beamHeadingRad(shownS: number): number {
  return 2 * Math.PI * ((shownS / kTurnS) % 1);
}

export class Landscape {
  readonly group = new Group();
  private readonly lights: Light[] = [];
  private readonly geometries: BufferGeometry[] = [];

  /** Takes ownership of `ground`. Materials are shared; the caller disposes them. `isLandless`: of an open sea, with a lighthouse and a sailing boat far away. */
  constructor(bed: Bed, ground: BufferGeometry, obstacles: readonly ObstacleInfo[], material: RawShaderMaterial, plain: boolean, { isLandless = false, groundMaterial = material } = {}) {
    this.add(ground, groundMaterial);
    if (isLandless) {
      const { geometry, lampM } = makeSkerry(longSideM(bed), bed.depthM, plain);
      this.add(geometry, material);
      this.lights.push({ kind: "lighthouse", atM: lampM });
    }
    // The longest breakwater has the lighthouse.
    const longestM = Math.max(...obstacles.map((each) => (each.shape === "breakwater" ? each.lengthM : 0)));
    for (const obstacle of obstacles) {
      // Down to the bed at the obstacle's middle, and deeper by a quarter of the depth for a sloping bed.
      const depthM = Math.min(depthAtM(bed, obstacle.xM, obstacle.zM) + 0.25 * bed.depthM, bed.depthM);
      if (obstacle.shape === "rock") {
        castsShadow(this.add(makeRockGeometry(obstacle, depthM, plain), material));
        continue;
      }
      const kind = obstacle.lengthM === longestM && this.lights.every((light) => light.kind !== "lighthouse") ? "lighthouse" : "beacon";
      const { geometry, lamp } = makeBreakwater(obstacle, depthM, kind, plain);
      const mesh = this.add(geometry, material);
      castsShadow(mesh);
      mesh.position.set(obstacle.xM, 0, obstacle.zM);
      mesh.rotation.y = -obstacle.headingRad;
      mesh.updateMatrixWorld();
      this.lights.push({ kind, atM: mesh.localToWorld(new Vector3(lamp.xM, lamp.yM, 0)) });
    }
  }

  /** Adds the lights of the breakwaters: a beacon, and a lighthouse with two beams that turn. */
  collectLamps(lamps: Lamps, shownS: number): void {
    for (const { kind, atM } of this.lights) {
      const { x, y, z } = atM;
      if (kind === "beacon") {
        lamps.add(x, y, z, 0.3 * y, kLampColors.green);
        continue;
      }
      lamps.add(x, y, z, 0.4 * y, kLampColors.white);
      const headingRad = beamHeadingRad(shownS);
      for (const way of [-1, 1])
        lamps.addBeam(x, y, z, kBeamEndHeights * y, kLampColors.white, way * kBeamHeights * y * Math.cos(headingRad), 0, way * kBeamHeights * y * Math.sin(headingRad));
    }
  }

  dispose(): void {
    for (const geometry of this.geometries) geometry.dispose();
  }

  private add(geometry: BufferGeometry, material: RawShaderMaterial): Mesh {
    const mesh = new Mesh(geometry, material);
    this.geometries.push(geometry);
    this.group.add(mesh);
    return mesh;
  }
}

// A swimming pool: tiled floor and walls, a rounded coping, a deck of slabs, and a garden around it.
import { Group, Mesh, type BufferGeometry, type RawShaderMaterial } from "three";

import type { GreetingInfo } from "../../../client/codec/greeting";
import { addGarden, deckOf } from "../landscape/garden";
import { castsShadow } from "../meshes/casters";
import { MeshBuilder, type Paint } from "../meshes/mesh_builder";
import { addWalls } from "../meshes/shapes";
import type { SurroundingsContext } from "./surroundings_context";
import { makeTiles } from "./tiles";

/** Shares of the side: rim over the water, and its width. */
const kRimHeight = 0.026;
const kRimMostM = 0.4;
const kRimWidth = 0.028;
const kTilesPerSide = 36;
/** Lane lines on the floor: their number, and width in sides. */
const kLaneCount = 3;
const kLaneWidth = 0.022;

// The fourth number is the side of a tile, in sides of the water (tiles.frag).
const kFloorTile: Paint = [0.60, 0.72, 0.73, 1 / kTilesPerSide];
const kWallTile: Paint = [0.60, 0.72, 0.74, 1 / kTilesPerSide];
const kBandTile: Paint = [0.05, 0.17, 0.36, 1 / kTilesPerSide];
const kRim: Paint = [0.80, 0.77, 0.70, 1 / 20];
/** Rounded edge of the coping: outward and upward, in its height. */
const kCopingProfile = [[-1, -1], [-1, 0.3], [-0.8, 0.75], [-0.35, 1]] as const;

interface BasinGeometries {
  tiled: BufferGeometry;
  deck: BufferGeometry;
  planted: BufferGeometry;
}

/** A level ring of four strips between two rectangles. */
function addRing(builder: MeshBuilder, yM: number, inner: readonly [number, number], outer: readonly [number, number], paint: Paint): void {
  const [ix, iz] = inner;
  const [ox, oz] = outer;
  const strip = (x0: number, x1: number, z0: number, z1: number): void => {
    builder.quad([x0, yM, z1], [x1, yM, z1], [x1, yM, z0], [x0, yM, z0], paint);
  };
  strip(-ox, ox, iz, oz);
  strip(-ox, ox, -oz, -iz);
  strip(-ox, -ix, -iz, iz);
  strip(ix, ox, -iz, iz);
}

/** Returns the basin with its floor at y = 0 and the water's rest level at `depthM`. */
export function makeBasinGeometries(lengthM: number, widthM: number, depthM: number, plain = false): BasinGeometries {
  const half: [number, number] = [lengthM / 2, widthM / 2];
  const sideM = Math.max(lengthM, widthM);  // what tiles, rim and deck are shares of
  const grown = (byM: number): [number, number] => [half[0] + byM, half[1] + byM];
  const rimM = depthM + Math.min(kRimHeight * sideM, kRimMostM);
  const bandM = depthM - 0.012 * sideM;
  const tiled = new MeshBuilder();
  // Floor in strips along x: tiles and lane lines in turn.
  const laneM = kLaneWidth * sideM;
  let fromM = half[1];
  for (let lane = 0; lane <= kLaneCount; ++lane) {
    const middleM = half[1] - (2 * half[1] * (lane + 1)) / (kLaneCount + 1);
    const toM = lane < kLaneCount ? middleM + laneM / 2 : -half[1];
    tiled.quad([-half[0], 0, fromM], [half[0], 0, fromM], [half[0], 0, toM], [-half[0], 0, toM], kFloorTile);
    if (lane < kLaneCount) tiled.quad([-half[0], 0, toM], [half[0], 0, toM], [half[0], 0, toM - laneM], [-half[0], 0, toM - laneM], kBandTile);
    fromM = toM - laneM;
  }
  addWalls(tiled, half, 0, bandM, true, kWallTile);
  addWalls(tiled, half, bandM, rimM, true, kBandTile);
  const deck = new MeshBuilder();
  const liftM = 0.006 * sideM;
  const rows = kCopingProfile.map(([out, up]) => {
    const [x, z] = grown(out * liftM);
    const yM = rimM + up * liftM;
    return [[x, yM, z], [-x, yM, z], [-x, yM, -z], [x, yM, -z], [x, yM, z]] as const;
  });
  for (let side = 0; side < 4; ++side) deck.grid(rows.map((row) => [row[side]!, row[side + 1]!]), kRim);
  const outerM = kRimWidth * sideM;
  addRing(deck, rimM + liftM, grown(-0.35 * liftM), grown(outerM), kRim);
  addWalls(deck, grown(outerM), rimM, rimM + liftM, false, kRim);
  const { widthM: deckM, paint } = deckOf(sideM);
  addRing(deck, rimM, grown(outerM), grown(deckM), paint);
  const planted = new MeshBuilder();
  addGarden(planted, deck, paint, { halfM: half, waterM: depthM, deckM: rimM }, plain);
  return { tiled: tiled.build(), deck: deck.build(), planted: planted.build() };
}

export class PoolBasin {
  readonly group = new Group();
  private readonly geometries: BasinGeometries;
  private readonly materials: readonly [tiles: RawShaderMaterial, stone: RawShaderMaterial];

  constructor(greeting: GreetingInfo, context: SurroundingsContext) {
    const { sideM, widthM, waterExtents } = greeting;
    const { depthM } = waterExtents;
    this.geometries = makeBasinGeometries(sideM, widthM, depthM, context.quality.plain);
    this.materials = [makeTiles(greeting, context), makeTiles(greeting, context, "wet")];
    const [tiled, deck] = [new Mesh(this.geometries.tiled, this.materials[0]), new Mesh(this.geometries.deck, this.materials[1])];
    const planted = new Mesh(this.geometries.planted, context.solid);
    castsShadow(tiled);
    castsShadow(deck);
    // Without a map of shadows, those on the water are drawn, which plants do not reach at noon.
    if (context.shadow) castsShadow(planted);
    for (const mesh of [tiled, deck, planted]) {
      mesh.frustumCulled = false;
      this.group.add(mesh);
    }
    this.setFloorM(-depthM);
  }

  setFloorM(yM: number): void {
    this.group.position.y = yM;
  }

  dispose(): void {
    const { tiled, deck, planted } = this.geometries;
    for (const each of [tiled, deck, planted, ...this.materials]) each.dispose();
  }
}

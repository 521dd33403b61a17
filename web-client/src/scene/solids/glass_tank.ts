// A glass tank or flume in a garden, on a deck of stone; a small tray stands on a table. A tank's walls are tiled, and only
// their inner side is drawn: one looks through the near panes at the water, with the far walls behind it.
import { CustomBlending, DoubleSide, FrontSide, Group, Mesh, OneFactor, SrcAlphaFactor, Vector3, type BufferGeometry, type RawShaderMaterial } from "three";

import type { GreetingInfo } from "../../../client/codec/greeting";
import { addGarden, deckOf, kTeak } from "../landscape/garden";
import { kTankTile } from "../landscape/paints";
import { castsShadow } from "../meshes/casters";
import { MeshBuilder, type Paint } from "../meshes/mesh_builder";
import { addRod, addWalls } from "../meshes/shapes";
import { makeMaterial, type Uniforms } from "../shaders/materials";
import type { SurroundingsContext } from "./surroundings_context";
import { makeTiles } from "./tiles";

/** Thickness of the glass and of the base: a share of the tank's size. */
const kGlassThickness = 0.004;
/** Rim of the glass over the resting water: a share of the depth, and at least one of the tank's size. */
const kFreeboardDepths = 0.45;
const kFreeboardSides = 0.06;
/** The same of a channel of particles, whose waves are as high as its water is deep: the longer side is so many of the shorter ones. */
const kParticlesFreeboardSides = 0.3;
const kChannelWidths = 4;
/** Share of its height that a first view shows: the rim would be a line across the picture. */
const kShownOfChannel = 0.8;
/** The size of a long channel is this many of its shorter sides: its glass is not those of a wide tank. */
const kSizeWidths = 6;
/** Height of the plate under the tank, in thicknesses of the glass. */
const kPlinth = 5;

/** Side of the tiles in a tank, and in a tray: a share of its size. */
const kTileShare = 1 / 44;
const kTrayTileShare = 1 / 20;
/** The walls end at this share of the glass that stands over the resting water. In a channel of particles, whose waves shall be seen
 * against the sky, they have this share of the height of the glass, and at most one of its length: a tall tank is of glass. */
const kWallFreeboard = 0.25;
const kChannelWallHeight = 0.5;
const kChannelWallLength = 0.16;
/** What is kept free around a tank, from its middle and beside it. */
const kFreeHalfM = 3;
const kFreeBesideM = 1.6;
/** A tank of which no side is longer stands on a table of this height, with room beside it. */
const kTrayM = 1.2;
const kTableM = 0.74;
const kTableBesideM = 0.22;
const kPlankM = 0.09;

const kBase: Paint = [0.42, 0.43, 0.42, 0.6];
// Of glass only the last number counts: 0 a pane, 1 a cut edge (glass.frag).
const kPane: Paint = [1, 1, 1, 0];
const kCutEdge: Paint = [1, 1, 1, 1];

interface TankSize {
  sideM: number;
  widthM: number;
  /** From the floor to the rim of the glass, and to the top of the walls. */
  heightM: number;
  wallM: number;
}

/** The length that glass and rim are shares of: the longer side. */
function sizeM({ sideM, widthM }: Pick<TankSize, "sideM" | "widthM">): number {
  return Math.min(Math.max(sideM, widthM), kSizeWidths * Math.min(sideM, widthM));
}

function isTray({ sideM, widthM }: Pick<TankSize, "sideM" | "widthM">): boolean {
  return Math.max(sideM, widthM) < kTrayM;
}

function isChannelOfParticles({ sideM, widthM, wave }: Pick<GreetingInfo, "sideM" | "widthM" | "wave">): boolean {
  return !wave && Math.max(sideM, widthM) > kChannelWidths * Math.min(sideM, widthM);
}

/** Returns the side of the tiles, in sides of the water (tiles.frag). */
export function tileSides(size: Pick<TankSize, "sideM" | "widthM">): number {
  return ((isTray(size) ? kTrayTileShare : kTileShare) * sizeM(size)) / Math.max(size.sideM, size.widthM);
}

/** Returns the height over the floor that the first view of a tank of particles shows. */
export function shownHeightM(greeting: Pick<GreetingInfo, "sideM" | "widthM" | "waterExtents" | "wave">): number {
  return isChannelOfParticles(greeting) ? kShownOfChannel * tankSize(greeting).heightM : greeting.waterExtents.depthM;
}

/** Returns the tank that holds the scene's water, with room for waves. */
export function tankSize(greeting: Pick<GreetingInfo, "sideM" | "widthM" | "waterExtents" | "wave">): TankSize {
  const { sideM, widthM, waterExtents } = greeting;
  const { depthM } = waterExtents;
  const isChannel = isChannelOfParticles(greeting);
  const freeboardM = Math.max(kFreeboardDepths * depthM, (isChannel ? kParticlesFreeboardSides : kFreeboardSides) * sizeM({ sideM, widthM }));
  const heightM = depthM + freeboardM;
  return { sideM, widthM, heightM, wallM: isChannel ? Math.min(kChannelWallHeight * heightM, kChannelWallLength * Math.max(sideM, widthM)) : depthM + kWallFreeboard * freeboardM };
}

/** Four panes between four edges, with a rim. The floor of the tank is at y = 0. */
export function makeGlassGeometry({ sideM, widthM, heightM }: TankSize): BufferGeometry {
  const halfM = (kGlassThickness * sizeM({ sideM, widthM })) / 2;
  const builder = new MeshBuilder();
  const [hx, hz] = [sideM / 2, widthM / 2];
  const railM = heightM - halfM;
  const upright = (xM: number, zM: number, halfX: number, halfZ: number, paint: Paint): void => {
    builder.block(xM, zM, { yM: 0, halfX, halfZ }, { yM: railM, halfX, halfZ }, paint);
    builder.block(xM, zM, { yM: railM, halfX, halfZ }, { yM: heightM, halfX, halfZ }, kCutEdge);
  };
  for (const side of [-1, 1]) {
    // A gap to the water, whose sides would otherwise lie in the same planes.
    upright(0, side * (hz + 1.1 * halfM), hx, 0.9 * halfM, kPane);
    upright(side * (hx + 1.1 * halfM), 0, 0.9 * halfM, hz, kPane);
    for (const end of [-1, 1]) upright(side * (hx + halfM), end * (hz + halfM), halfM, halfM, kCutEdge);
  }
  return builder.build();
}

/** A table of planks along x that stands at `footM`. */
function addTable(builder: MeshBuilder, halfX: number, halfZ: number, footM: number): void {
  const topM = footM + kTableM;
  const planksCount = Math.round((2 * halfZ) / kPlankM);
  const planeM = halfZ / planksCount;
  for (let n = 0; n < planksCount; ++n) {
    const plank = { halfX, halfZ: 0.96 * planeM };
    builder.block(0, (2 * n + 1 - planksCount) * planeM, { yM: topM - 0.03, ...plank }, { yM: topM, ...plank }, kTeak);
  }
  for (const x of [-1, 1]) for (const z of [-1, 1]) addRod(builder, [0.9 * x * halfX, footM, 0.9 * z * halfZ], [0.9 * x * halfX, topM - 0.03, 0.9 * z * halfZ], 0.035, kTeak);
}

/** The painted walls of a tray, in its glass. */
function addTrayWalls(builder: MeshBuilder, { sideM, widthM, wallM }: TankSize): void {
  const halfM = kGlassThickness * sizeM({ sideM, widthM });
  const wall = (xM: number, zM: number, halfX: number, halfZ: number): MeshBuilder => builder.block(xM, zM, { yM: 0, halfX, halfZ }, { yM: wallM, halfX, halfZ }, [...kTankTile, 0.2]);
  for (const side of [-1, 1]) {
    wall(0, side * (widthM / 2 + 1.05 * halfM), sideM / 2 + 2.05 * halfM, halfM);
    wall(side * (sideM / 2 + 1.05 * halfM), 0, halfM, widthM / 2);
  }
}

/** Returns the height of the deck under the tank's floor. */
function deckM(size: TankSize): number {
  return -kPlinth * kGlassThickness * sizeM(size) - (isTray(size) ? kTableM : 0);
}

/** What the tank stands on: a plate, and under a tray a table. */
export function makeBaseGeometry(size: TankSize): BufferGeometry {
  const thickM = kGlassThickness * sizeM(size);
  const builder = new MeshBuilder();
  const [halfX, halfZ] = [size.sideM / 2 + thickM, size.widthM / 2 + thickM];
  builder.block(0, 0, { yM: -kPlinth * thickM, halfX, halfZ }, { yM: -0.12 * thickM, halfX, halfZ }, kBase);
  if (isTray(size)) {
    addTable(builder, halfX + kTableBesideM, halfZ + kTableBesideM, deckM(size));
    addTrayWalls(builder, size);
  }
  return builder.build();
}

function makeGarden(size: TankSize, plain: boolean): { deck: BufferGeometry; planted: BufferGeometry } {
  const halfM = [size.sideM, size.widthM].map((lengthM) => Math.max(lengthM / 2 + kFreeBesideM, kFreeHalfM)) as [number, number];
  const sideM = 2 * Math.max(...halfM);
  const { widthM, paint } = deckOf(sideM);
  const slabs: Paint = [paint[0], paint[1], paint[2], (paint[3] * sideM) / Math.max(size.sideM, size.widthM)];
  const planted = new MeshBuilder();
  const deck = level(halfM[0] + widthM, deckM(size), halfM[1] + widthM, slabs);
  addGarden(planted, deck, slabs, { halfM, deckM: deckM(size) }, plain);
  return { deck: deck.build(), planted: planted.build() };
}

/** The tiles of the floor, and of a tank's walls. */
function makeLining(size: TankSize): BufferGeometry {
  const [halfX, halfZ] = [size.sideM / 2, size.widthM / 2];
  const gapM = 0.06 * kGlassThickness * sizeM(size);
  const paint: Paint = [...kTankTile, tileSides(size)];
  const lining = level(halfX, -gapM, halfZ, paint);
  if (!isTray(size)) addWalls(lining, [halfX + gapM, halfZ + gapM], -gapM, size.wallM, true, paint);
  return lining.build();
}

/** A level rectangle around the middle. */
function level(xM: number, yM: number, zM: number, paint: Paint): MeshBuilder {
  return new MeshBuilder().quad([-xM, yM, zM], [xM, yM, zM], [xM, yM, -zM], [-xM, yM, -zM], paint);
}

export class GlassTank {
  /** What the tank stands on. */
  readonly group = new Group();
  readonly glass: Mesh<BufferGeometry, RawShaderMaterial>;
  /** Of the tiles in the tank. */
  readonly tiles: RawShaderMaterial;
  /** The tiles in the tank, and the deck. */
  private readonly floors: readonly Mesh<BufferGeometry, RawShaderMaterial>[];
  private readonly base: Mesh;
  private readonly planted: Mesh;
  private readonly uniforms: Uniforms;

  constructor(greeting: GreetingInfo, context: SurroundingsContext) {
    const { sky, solid, quality, shadow } = context;
    const size = tankSize(greeting);
    this.uniforms = { ...sky.uniforms, u_camera_m: { value: new Vector3() } };
    this.glass = new Mesh(
      makeGlassGeometry(size),
      makeMaterial("glass", this.uniforms, {
        // Each pane has two faces; plain tiers draw the one that faces the camera.
        side: quality.plain ? FrontSide : DoubleSide,
        depthWrite: false,
        transparent: true,
        blending: CustomBlending,
        blendSrc: OneFactor,
        blendDst: SrcAlphaFactor,
      }),
    );
    this.base = new Mesh(makeBaseGeometry(size), solid);
    const { deck, planted } = makeGarden(size, quality.plain);
    this.planted = new Mesh(planted, solid);
    this.tiles = makeTiles(greeting, context);
    this.floors = [
      new Mesh(makeLining(size), this.tiles),
      new Mesh(deck, makeTiles(greeting, context, "dry")),
    ];
    for (const mesh of [this.glass, this.base, this.planted, ...this.floors]) mesh.frustumCulled = false;
    castsShadow(this.base);
    if (shadow) castsShadow(this.planted);
    this.group.add(this.base, this.planted, ...this.floors);
    this.setFloorM(greeting.wave ? -greeting.waterExtents.depthM : 0);
  }

  setFloorM(yM: number): void {
    this.group.position.y = yM;
    this.glass.position.y = yM;
  }

  look(cameraM: Vector3): void {
    (this.uniforms["u_camera_m"]!.value as Vector3).copy(cameraM);
  }

  dispose(): void {
    this.glass.geometry.dispose();
    this.glass.material.dispose();
    this.base.geometry.dispose();
    this.planted.geometry.dispose();
    for (const { geometry, material } of this.floors) {
      geometry.dispose();
      material.dispose();
    }
  }
}

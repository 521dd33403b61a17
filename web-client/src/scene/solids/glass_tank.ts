// A glass tank on a table, or a laboratory flume on a steel frame, in a lit room. The room is the cube map that stands for the sky
// (room_bake.frag).
import { CustomBlending, DoubleSide, FrontSide, Group, Mesh, OneFactor, SrcAlphaFactor, Vector2, Vector3, type BufferGeometry, type RawShaderMaterial } from "three";

import type { GreetingInfo } from "../../../client/codec/greeting";
import { castsShadow } from "../meshes/casters";
import { MeshBuilder, type Paint } from "../meshes/mesh_builder";
import { makeMaterial, type Uniforms } from "../shaders/materials";
import type { SurroundingsContext } from "./surroundings_context";

/** Shares of the tank's size: thickness of the glass, of the table, and how far it reaches beyond the glass. */
const kGlassThickness = 0.008;
const kTableThickness = 0.05;
const kTableReach = 0.35;
/** Rim of the glass over the resting water: a share of the depth, and at least one of the tank's size. */
const kFreeboardDepths = 0.45;
const kFreeboardSides = 0.06;
/** Thickness of the beams and legs that carry a flume, in its widths. */
const kBeamWidths = 0.025;
/** Pairs of a flume's legs along its length, for each of its sizes. */
const kBayCount = 2;
/** The size of a long channel is this many of its shorter sides: its glass and frame are not those of a wide tank. */
const kSizeWidths = 6;

// Grain, as for other solids: 0 is paint, more is rough.
const kTable: Paint = [0.12, 0.075, 0.045, 0.2];
const kTableEdge: Paint = [0.10, 0.06, 0.035, 0.2];
const kSteel: Paint = [0.16, 0.17, 0.19, 0.05];
/** Pale, so that it shows the light that the water focuses. */
const kBase: Paint = [0.5, 0.52, 0.51, 0.1];
// Of glass only the last number counts: 0 a pane, 1 a cut edge (glass.frag).
const kPane: Paint = [1, 1, 1, 0];
const kCutEdge: Paint = [1, 1, 1, 1];

interface TankSize {
  sideM: number;
  widthM: number;
  /** From the floor to the rim. */
  heightM: number;
  isFlume: boolean;
}

/** The length that glass, table and frame are shares of: the longer side. */
function sizeM({ sideM, widthM }: Pick<TankSize, "sideM" | "widthM">): number {
  return Math.min(Math.max(sideM, widthM), kSizeWidths * Math.min(sideM, widthM));
}

/** Returns the tank that holds the scene's water, with room for waves. */
export function tankSize(greeting: Pick<GreetingInfo, "sideM" | "widthM" | "waterExtents" | "setting">): TankSize {
  const { sideM, widthM, waterExtents } = greeting;
  const { depthM } = waterExtents;
  const freeboardM = Math.max(kFreeboardDepths * depthM, kFreeboardSides * sizeM({ sideM, widthM }));
  return { sideM, widthM, heightM: depthM + freeboardM, isFlume: greeting.setting === "flume" };
}

/** Four panes between four edges, without a frame: nothing stands before the water. The floor of the tank is at y = 0. */
export function makeGlassGeometry({ sideM, widthM, heightM }: TankSize): BufferGeometry {
  const halfM = (kGlassThickness * sizeM({ sideM, widthM })) / 2;
  const builder = new MeshBuilder();
  const [hx, hz] = [sideM / 2, widthM / 2];
  const upright = (xM: number, zM: number, halfX: number, halfZ: number, paint: Paint): void => {
    builder.block(xM, zM, { yM: 0, halfX, halfZ }, { yM: heightM, halfX, halfZ }, paint, kCutEdge);
  };
  for (const side of [-1, 1]) {
    // A gap to the water, whose sides would otherwise lie in the same planes.
    upright(0, side * (hz + 1.1 * halfM), hx, 0.9 * halfM, kPane);
    upright(side * (hx + 1.1 * halfM), 0, 0.9 * halfM, hz, kPane);
    for (const end of [-1, 1]) upright(side * (hx + halfM), end * (hz + halfM), halfM, halfM, kCutEdge);
  }
  return builder.build();
}

/** What carries the tank: a table, or the frame of a flume. */
export function makeStandGeometry({ sideM, widthM, isFlume }: TankSize): BufferGeometry {
  const longM = sizeM({ sideM, widthM });
  const bayCount = Math.max(Math.round((kBayCount * Math.max(sideM, widthM)) / longM), 1);
  const thickM = kGlassThickness * longM;
  const builder = new MeshBuilder();
  const [hx, hz] = [sideM / 2 + thickM, widthM / 2 + thickM];
  const box = (xM: number, zM: number, lowM: number, highM: number, halfX: number, halfZ: number, paint: Paint, top = paint): void => {
    builder.block(xM, zM, { yM: lowM, halfX, halfZ }, { yM: highM, halfX, halfZ }, paint, top);
  };
  const bedM = 0.01 * longM;
  box(0, 0, -bedM, -0.0005 * longM, hx, hz, kSteel, kBase);
  if (!isFlume) {
    const reachM = kTableReach * longM;
    const tableM = kTableThickness * longM;
    box(0, 0, -bedM - tableM, -bedM, hx + reachM, hz + reachM, kTableEdge, kTable);
    const legM = 0.05 * longM;
    for (const x of [-1, 1])
      for (const z of [-1, 1]) box(x * (hx + reachM - 2 * legM), z * (hz + reachM - 2 * legM), -bedM - tableM - 0.9 * longM, -bedM - tableM, legM, legM, kTableEdge);
    return builder.build();
  }
  const beamM = kBeamWidths * Math.min(sideM, widthM);
  const isAlongX = sideM >= widthM;
  box(0, 0, -bedM - 2.5 * beamM, -bedM, hx + beamM, hz + beamM, kSteel);
  for (let bay = 0; bay <= bayCount; ++bay) {
    const along = (bay / bayCount - 0.5) * 2;
    for (const side of [-1, 1]) {
      const [xM, zM] = isAlongX ? [along * hx, side * hz] : [side * hx, along * hz];
      box(xM, zM, -bedM - 0.4 * longM, -bedM - 2.5 * beamM, beamM, beamM, kSteel);
    }
  }
  return builder.build();
}

export class GlassTank {
  /** The stand. */
  readonly group = new Group();
  readonly glass: Mesh<BufferGeometry, RawShaderMaterial>;
  private readonly stand: Mesh;
  private readonly uniforms: Uniforms;

  constructor(greeting: GreetingInfo, { sky, solid, quality }: SurroundingsContext) {
    const size = tankSize(greeting);
    this.uniforms = { ...sky.uniforms, u_camera_m: { value: new Vector3() }, u_half_m: { value: new Vector2(size.sideM / 2, size.widthM / 2) } };
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
    this.stand = new Mesh(makeStandGeometry(size), solid);
    for (const mesh of [this.glass, this.stand]) mesh.frustumCulled = false;
    castsShadow(this.stand);
    this.group.add(this.stand);
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
    this.stand.geometry.dispose();
  }
}

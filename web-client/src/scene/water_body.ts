// The water: a grid displaced by the field, and vertical sides (the skirt) down to the floor where it has them. In the open sea the grid
// goes on to the horizon and has no sides.
import { BufferAttribute, BufferGeometry, DoubleSide, FrontSide, Group, Mesh, Vector2, Vector3, Vector4, type RawShaderMaterial, type Texture } from "three";

import type { SideKind, SideName } from "../codec/scene_info";
import { makeMaterial, type Uniforms } from "./shaders";
import type { Sky } from "./sky";
import { bedUniformValues, type Bed } from "./terrain";

export interface BehindTextures {
  color: Texture;
  depth: Texture;
}

/** The grid of an open sea reaches this many sides of the square, past the horizon's last pixel. */
const kSeaReachSides = 300;
/** Its cells outside the square become larger by this factor, first slowly, for the waves near the square. */
const kNearGrowth = 1.2;
const kNearCount = 6;
const kFarGrowth = 2.2;

/**
 * Returns the places of the grid's lines along one axis: `cellsCount` equal cells over -1/2..1/2, and beyond the ends that are open
 * cells that grow toward the horizon.
 */
export function gridLines(cellsCount: number, openBelow: boolean, openAbove: boolean): number[] {
  const inside = Array.from({ length: cellsCount + 1 }, (_, i) => i / cellsCount - 0.5);
  const outside: number[] = [];
  let step = 1 / cellsCount;
  for (let at = 0.5, n = 0; at < kSeaReachSides; ++n) {
    step *= n < kNearCount ? kNearGrowth : kFarGrowth;
    at += step;
    outside.push(at);
  }
  return [...(openBelow ? outside.map((at) => -at).reverse() : []), ...inside, ...(openAbove ? outside : [])];
}

/** Grid of the given lines; y = 1 ("on the surface" for the shader). */
function makeGrid(xs: readonly number[], zs: readonly number[]): BufferGeometry {
  const positions = new Float32Array(xs.length * zs.length * 3);
  let at = 0;
  for (const z of zs)
    for (const x of xs) {
      positions[at++] = x;
      positions[at++] = 1;
      positions[at++] = z;
    }
  const index = new Uint32Array((xs.length - 1) * (zs.length - 1) * 6);
  at = 0;
  for (let k = 0; k + 1 < zs.length; ++k)
    for (let i = 0; i + 1 < xs.length; ++i) {
      const corner = k * xs.length + i;
      for (const vertex of [corner, corner + xs.length, corner + 1, corner + 1, corner + xs.length, corner + xs.length + 1])
        index[at++] = vertex;
    }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setIndex(new BufferAttribute(index, 1));
  return geometry;
}

/** Four strips, each `cellsCount` quads from the surface (y = 1) to the floor (y = 0), normals outward. */
function makeSkirt(cellsCount: number): BufferGeometry {
  const positions: number[] = [];
  const normals: number[] = [];
  const index: number[] = [];
  const sides: [number, number][] = [[0, 1], [1, 0], [0, -1], [-1, 0]];
  for (const [nx, nz] of sides) {
    const first = positions.length / 3;
    for (let i = 0; i <= cellsCount; ++i) {
      const along = i / cellsCount - 0.5;
      const x = nx * 0.5 + nz * along;
      const z = nz * 0.5 - nx * along;
      positions.push(x, 1, z, x, 0, z);
      normals.push(nx, 0, nz, nx, 0, nz);
      if (i === cellsCount) continue;
      const top = first + 2 * i;
      index.push(top, top + 1, top + 2, top + 2, top + 1, top + 3);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
  geometry.setAttribute("normal", new BufferAttribute(new Float32Array(normals), 3));
  geometry.setIndex(index);
  return geometry;
}

/** What bounds the water at its sides. */
export type WaterEdge =
  /** It goes on as a sea, except at closed sides. */
  | { kind: "sea"; sea: Uniforms; sides: Readonly<Record<SideName, SideKind>>; hazeM: number }
  /** Its sides are seen: a block of water, or water behind glass. */
  | { kind: "cut" }
  /** Walls, which others draw. */
  | { kind: "walls" };

export class WaterBody {
  readonly group = new Group();
  private readonly meshes: Mesh<BufferGeometry, RawShaderMaterial>[];
  private readonly uniforms: Uniforms;

  /** `foam` undefined: the room sends none. `hasSolids`: the water reflects solids as well as the sky. */
  constructor(sky: Sky, field: Texture, behind: BehindTextures, bed: Bed, noise: Texture, foam: Uniforms | undefined, hasSolids: boolean, edge: WaterEdge, quality: { surfaceCellsCount: number; plain: boolean }) {
    const { sideM, depthM, beaches } = bed;
    const { widthsM, shoreDepthsM } = bedUniformValues(bed);
    this.uniforms = {
      ...sky.uniforms,
      u_field: { value: field },
      u_behind: { value: behind.color },
      u_behind_depth: { value: behind.depth },
      u_camera_m: { value: new Vector3() },
      u_resolution: { value: new Vector2(1, 1) },
      u_near_far_m: { value: new Vector2(1, 2) },
      u_side_m: { value: sideM },
      u_depth_m: { value: depthM },
      u_beach_width_m: { value: new Vector4(...widthsM) },
      u_shore_depth_m: { value: new Vector4(...shoreDepthsM) },
      u_noise: { value: noise },
      u_lace_m: { value: Math.min(Math.max(sideM / 7, 1), 9) },
      ...foam,
      ...(edge.kind === "sea" && { ...edge.sea, u_haze_m: { value: edge.hazeM } }),
    };
    const cellsCount = quality.surfaceCellsCount;
    const defines: Record<string, number> = {};
    if (quality.plain) defines["PLAIN"] = 1;
    if (beaches.length > 0) defines["BEACH"] = 1;
    if (foam) defines["FOAM"] = 1;
    if (hasSolids) defines["MIRROR"] = 1;
    const isSea = edge.kind === "sea";
    if (isSea) defines["OPEN_SEA"] = 1;
    const opens = (side: SideName): boolean => isSea && edge.sides[side] !== "closed";
    const grid = makeGrid(gridLines(cellsCount, opens("-x"), opens("+x")), gridLines(cellsCount, opens("-z"), opens("+z")));
    this.meshes = [new Mesh(grid, makeMaterial("water", this.uniforms, { side: DoubleSide, defines }))];
    if (edge.kind === "cut")
      this.meshes.push(new Mesh(makeSkirt(cellsCount), makeMaterial("water", this.uniforms, { side: FrontSide, defines: { ...defines, SKIRT: 1 } })));
    for (const mesh of this.meshes) {
      mesh.frustumCulled = false;
      this.group.add(mesh);
    }
  }

  update(cameraM: Vector3, nearM: number, farM: number, behind: BehindTextures, widthPx: number, heightPx: number): void {
    (this.uniforms["u_camera_m"]!.value as Vector3).copy(cameraM);
    (this.uniforms["u_near_far_m"]!.value as Vector2).set(nearM, farM);
    (this.uniforms["u_resolution"]!.value as Vector2).set(widthPx, heightPx);
    this.uniforms["u_behind"]!.value = behind.color;
    this.uniforms["u_behind_depth"]!.value = behind.depth;
  }

  dispose(): void {
    for (const mesh of this.meshes) {
      mesh.geometry.dispose();
      mesh.material.dispose();
    }
  }
}

// The meshes of the water: a grid over the square, which in an open sea continues to the horizon, and the sides of a block of water.
import { BufferAttribute, BufferGeometry } from "three";

import type { SideName } from "../../../client/codec/scene_info";
import { clamp } from "../maths/interpolate";
import type { WaterEdge } from "../solids/surroundings_context";

interface Size {
  sideM: number;
  widthM: number;
}

/** The grid of an open sea reaches this many sides of the square, past the horizon's last pixel. */
const kSeaReachSides = 300;
/** Its cells outside the square become larger by this factor, first slowly, for the waves near the square. */
const kGrowth = { nearCount: 6, near: 1.2, far: 2.2 };
/** A grid with fewer cells than this grows faster: its vertices cost more than what they show. */
const kFewCells = 64;
const kFastGrowth = { nearCount: 3, near: 1.5, far: 3.5 };

/**
 * Returns the positions of the grid's lines along one axis: `cellsCount` equal cells over -1/2..1/2, and beyond the ends that are open
 * cells that grow toward the horizon.
 */
export function gridLines(cellsCount: number, openBelow: boolean, openAbove: boolean): number[] {
  const inside = Array.from({ length: cellsCount + 1 }, (_, i) => i / cellsCount - 0.5);
  const outside: number[] = [];
  const growth = cellsCount < kFewCells ? kFastGrowth : kGrowth;
  let step = 1 / cellsCount;
  for (let at = 0.5, n = 0; at < kSeaReachSides; ++n) {
    step *= n < growth.nearCount ? growth.near : growth.far;
    at += step;
    outside.push(at);
  }
  return [...(openBelow ? outside.map((at) => -at).reverse() : []), ...inside, ...(openAbove ? outside : [])];
}

/** Grid of the given lines; y = 1 ("on the surface" for the shader). */
export function makeGrid(xs: readonly number[], zs: readonly number[]): BufferGeometry {
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

/** Four strips of quads from the surface (y = 1) to the floor (y = 0), as many as there are cells along each axis, normals outward. */
function makeSkirt(cellsX: number, cellsZ: number): BufferGeometry {
  const positions: number[] = [];
  const normals: number[] = [];
  const index: number[] = [];
  const sides: [number, number][] = [[0, 1], [1, 0], [0, -1], [-1, 0]];
  for (const [nx, nz] of sides) {
    const first = positions.length / 3;
    const cellsCount = nx === 0 ? cellsX : cellsZ;
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

const kBeside: Record<"x" | "z", readonly SideName[]> = { x: ["+z", "-z"], z: ["+x", "-x"] };

/** A channel has at least so many cells across. */
const kLeastCells = 8;

/** Returns the cells of a grid along x and z, about as long as wide: together as many as those of a square with `cellsCount` along each side. */
export function cellsAlong(cellsCount: number, { sideM, widthM }: Size): [number, number] {
  const slender = clamp(Math.sqrt(sideM / widthM), kLeastCells / cellsCount, cellsCount / kLeastCells);
  return [Math.round(cellsCount * slender), Math.round(cellsCount / slender)];
}

/** Returns the meshes of a water's surface and, where they are seen, of its sides. `cellsCount`: along each side of a square. */
export function makeWaterGeometries(edge: WaterEdge, cellsCount: number, size: Size): { top: BufferGeometry; sides: BufferGeometry | undefined } {
  // Land at a closed side draws back where the sides beside it are open (landscape/coast.ts).
  const opens = (side: SideName): boolean => edge.kind === "sea" && (edge.sides[side] !== "closed" || kBeside[side[1] as "x" | "z"].some((each) => edge.sides[each] !== "closed"));
  const [cellsX, cellsZ] = cellsAlong(cellsCount, size);
  return {
    top: makeGrid(gridLines(cellsX, opens("-x"), opens("+x")), gridLines(cellsZ, opens("-z"), opens("+z"))),
    sides: edge.kind === "cut" ? makeSkirt(cellsX, cellsZ) : undefined,
  };
}

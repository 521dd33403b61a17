// Rocks as triangles, standing on the bed. Their outline at the level of the still water is that of the scene.
import type { BufferGeometry } from "three";

import type { RockInfo } from "../../../client/codec/scene_info";
import { clamp, mix, smooth, smoothstep } from "../maths/interpolate";
import { hash } from "../maths/random";
import { MeshBuilder, type Paint, type Point } from "../meshes/mesh_builder";
import { bedPaint, mixPaint, overgrown, shaded } from "./paints";

/** Rows and columns of a boulder; the second for software renderers. */
const kCounts = { full: { rings: 16, around: 26 }, plain: { rings: 9, around: 14 } } as const;
const kCutsCount = 13;
/** Colour of a rock, and the share of its height up to which weed grows over the still water. */
const kStone: Paint = [0.30, 0.275, 0.25, 1];
const kWeedHeights = 0.14;

/** Smooth value noise in 0..1. */
function bumps(x: number, y: number, z: number, seed: number): number {
  const [ix, iy, iz] = [Math.floor(x), Math.floor(y), Math.floor(z)];
  const [fx, fy, fz] = [smooth(x - ix), smooth(y - iy), smooth(z - iz)];
  const at = (dx: number, dy: number, dz: number): number => hash(ix + dx + 57 * (iz + dz), iy + dy, seed);
  const layer = (dz: number): number => mix(mix(at(0, 0, dz), at(1, 0, dz), fx), mix(at(0, 1, dz), at(1, 1, dz), fx), fy);
  return mix(layer(0), layer(1), fz);
}

/** Returns planes that cut pieces off a boulder: normal, and distance from the middle as a share of its size. */
function makeCuts(seed: number): [x: number, y: number, z: number, away: number][] {
  return Array.from({ length: kCutsCount }, (_, i) => {
    const round = 2 * Math.PI * ((i + hash(i, 5, seed)) / kCutsCount) * 3;
    const up = 0.05 + 0.95 * hash(i, 6, seed) ** 1.3;
    return [Math.cos(round) * Math.cos(up), Math.sin(up), Math.sin(round) * Math.cos(up), 0.64 + 0.28 * hash(i, 7, seed)];
  });
}

/** Adds one boulder: a cut dome over the water, a widening foot under it. */
function addBoulder(builder: MeshBuilder, rock: RockInfo, bottomM: number, seed: number, { rings, around }: (typeof kCounts)["full" | "plain"]): void {
  const { radiusM, heightM } = rock;
  const cuts = makeCuts(seed);
  const rows: Point[][] = [];
  for (let ring = 0; ring <= rings; ++ring) {
    const share = ring / rings;
    const row: Point[] = [];
    for (let i = 0; i <= around; ++i) {
      const angle = (2 * Math.PI * (i % around)) / around;
      const [c, s] = [Math.cos(angle), -Math.sin(angle)];
      // 0..0.4 under water, the rest above it.
      const under = Math.max(1 - share / 0.4, 0);
      const polar = Math.max((share - 0.4) / 0.6, 0) * (Math.PI / 2);
      const out = under > 0 ? 1 : Math.cos(polar) ** 0.85;
      let [x, y, z] = [c * out, Math.sin(polar), s * out];
      for (const [cutX, cutY, cutZ, away] of cuts) {
        // The flat faces end where the foot begins, whose outline is seen through the water.
        // At the waterline they hardly begin: there the outline is that of the simulated rock.
        const beyond = Math.max(cutX * x + cutY * y + cutZ * z - away, 0) * (1 - under) * clamp(0.2 + 2.2 * Math.sin(polar), 0, 1);
        [x, y, z] = [x - cutX * beyond, y - cutY * beyond, z - cutZ * beyond];
      }
      const rough = 0.6 * bumps(2.5 * x + 9, 2.5 * (y - under) + 5, 2.5 * z + 9, seed) + 0.4 * bumps(6 * x + 20, 6 * (y - under) + 7, 6 * z + 20, seed + 1);
      const wide = radiusM * (0.98 + 0.26 * rough) * (1 - 0.1 * under);
      const high = under > 0 ? bottomM * under + heightM * y * (1 - under) : heightM * y * (1.02 + 0.22 * (rough - 0.5));
      row.push([rock.xM + x * wide, high, rock.zM + z * wide]);
    }
    rows.push(row);
  }
  const weedM = kWeedHeights * heightM;
  builder.grid(rows, (row, column) => {
    const uneven = 0.8 + 0.4 * hash(row, column % around, seed);
    const highM = rows[row]![column]![1];
    const stone = overgrown(shaded(kStone, uneven), highM, weedM * (0.7 + 0.6 * hash(row >> 1, column >> 1, seed + 3)));
    // What grows on the foot is dark; sand lies on its lowest part.
    return mixPaint(shaded(stone, 1 - 0.35 * smoothstep(0, 0.15, highM / bottomM)), bedPaint(bottomM, -bottomM), smoothstep(0.85, 1, highM / bottomM));
  });
}

/** Returns a boulder of the scene's size with smaller ones beside it. `depthM`: water depth at the rock. */
export function makeRockGeometry(rock: RockInfo, depthM: number, plain = false): BufferGeometry {
  const counts = kCounts[plain ? "plain" : "full"];
  const builder = new MeshBuilder();
  const seed = Math.round(rock.xM * 131 + rock.zM * 977);
  const bottomM = -depthM - 0.1 * rock.radiusM;
  addBoulder(builder, rock, bottomM, seed, counts);
  for (let i = 0; i < 3; ++i) {
    const angle = 2 * Math.PI * (i / 3 + 0.25 * hash(i, 1, seed));
    const size = 0.3 + 0.2 * hash(i, 2, seed);
    const away = 0.98 * (1 - 0.7 * size) * rock.radiusM;
    addBoulder(
      builder,
      {
        shape: "rock", xM: rock.xM + away * Math.cos(angle), zM: rock.zM + away * Math.sin(angle),
        radiusM: size * rock.radiusM, heightM: rock.heightM * (0.25 + 0.35 * hash(i, 3, seed)),
      },
      bottomM, seed + 7 * i + 1, counts,
    );
  }
  return builder.build(true);
}

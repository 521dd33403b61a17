// The ground under the cells of a nonlinear wave, from which real depths follow. Pure.
import type { GreetingInfo } from "../../../client/codec/greeting";
import type { ObstacleInfo } from "../../../client/codec/scene_info";
import type { PlaneCounts } from "../frames/frame_textures";
import { bedOf, depthAtM, type Bed } from "../landscape/terrain";

/** Higher land counts as this high, as on the server (`kHighestLand_m` in sim_setup/ground.h). */
const kHighestLandM = 60;

/** Heights over the still water at the centres of a frame's samples; x fastest, from the smallest x and z. */
export interface ShoreCells extends PlaneCounts {
  /** With rocks and breakwaters: the elevation of a dry sample. */
  groundM: Float32Array;
  /** Without them. */
  bedM: Float32Array;
}

/** Returns the height of an obstacle over the still water as in the server's ground, by x and z; -Infinity where it is not. */
export function obstacleRise({ xM, zM, heightM, ...form }: ObstacleInfo): (xM: number, zM: number) => number {
  if (form.shape === "rock")
    return (x, z) => {
      // A dome over the water; below it a cone with the dome's slope at the water line.
      const share = Math.sqrt((x - xM) ** 2 + (z - zM) ** 2) / form.radiusM;
      return share < 1 ? heightM * (1 - share * share) : 2 * heightM * (1 - share);
    };
  const [c, s] = [Math.cos(form.headingRad), Math.sin(form.headingRad)];
  return (x, z) => (Math.abs((x - xM) * c + (z - zM) * s) <= form.lengthM / 2 && Math.abs((z - zM) * c - (x - xM) * s) <= form.widthM / 2 ? heightM : -Infinity);
}

/** Returns means of `values` over `wanted` equal parts of each of `linesCount` lines; samples of a line are `stride` apart. */
function meansAlong(values: Float32Array, count: number, stride: number, linesCount: number, lineStride: number, wanted: number): Float32Array {
  const out = new Float32Array(wanted * linesCount);
  const width = count / wanted;
  for (let part = 0; part < wanted; ++part) {
    const [from, to] = [part * width, (part + 1) * width];
    for (let cell = Math.floor(from); cell < Math.min(Math.ceil(to - 1e-9), count); ++cell) {
      const share = (Math.min(cell + 1, to) - Math.max(cell, from)) / width;
      for (let line = 0; line < linesCount; ++line) {
        const at = stride === 1 ? part + wanted * line : line + linesCount * part;
        out[at] = out[at]! + share * values[cell * stride + line * lineStride]!;
      }
    }
  }
  return out;
}

/** Returns a plane with other counts, each sample the mean over what it covers, as the server makes the levels of detail. */
export function meansOver(values: Float32Array, from: PlaneCounts, to: PlaneCounts): Float32Array {
  const alongX = meansAlong(values, from.resolutionCount, 1, from.countZ, from.resolutionCount, to.resolutionCount);
  return meansAlong(alongX, from.countZ, to.resolutionCount, to.resolutionCount, 1, to.countZ);
}

/** Returns the ground under the cells of the wave. */
export function shoreCells(bed: Bed, obstacles: readonly ObstacleInfo[], { resolutionCount, countZ }: PlaneCounts): ShoreCells {
  const groundM = new Float32Array(resolutionCount * countZ);
  const bedM = new Float32Array(resolutionCount * countZ);
  const rises = obstacles.map(obstacleRise);
  for (let k = 0; k < countZ; ++k)
    for (let i = 0; i < resolutionCount; ++i) {
      const xM = ((i + 0.5) / resolutionCount - 0.5) * bed.sideM;
      const zM = ((k + 0.5) / countZ - 0.5) * bed.widthM;
      const at = i + resolutionCount * k;
      let highestM = (bedM[at] = -depthAtM(bed, xM, zM));
      for (const rise of rises) highestM = Math.max(highestM, rise(xM, zM));
      groundM[at] = Math.min(highestM, kHighestLandM);
    }
  return { resolutionCount, countZ, groundM, bedM };
}

/** Returns the ground under the samples of frames with `counts`. */
export function shoreSamples(cells: ShoreCells, counts: PlaneCounts): ShoreCells {
  if (counts.resolutionCount === cells.resolutionCount && counts.countZ === cells.countZ) return cells;
  return { ...counts, groundM: meansOver(cells.groundM, cells, counts), bedM: meansOver(cells.bedM, cells, counts) };
}

/** Returns the ground by the counts of a frame, for a room whose water moves over its shore; undefined: the shore is fixed, or its ground not here yet. */
export function shoreOf(greeting: GreetingInfo): ((counts: PlaneCounts) => ShoreCells) | undefined {
  const { wave, beaches, obstacles, hasBed, ground } = greeting;
  if (!wave?.isNonlinear || (hasBed ? !ground : beaches.length === 0 && obstacles.length === 0)) return undefined;
  let cells: ShoreCells | undefined;
  let last: ShoreCells | undefined;
  return (counts) => {
    cells ??= shoreCells(bedOf(greeting), obstacles, wave);
    if (last?.resolutionCount !== counts.resolutionCount || last.countZ !== counts.countZ) last = shoreSamples(cells, counts);
    return last;
  };
}

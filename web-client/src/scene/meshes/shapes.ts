// Shapes that basins and fittings of boats, lighthouses and buoys are made of.
import type { MeshBuilder, Paint, Point } from "./mesh_builder";

const add = (a: Point, b: Point, share = 1): Point => [a[0] + share * b[0], a[1] + share * b[1], a[2] + share * b[2]];
const mix = (a: Point, b: Point, share: number): Point => [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])];
const cross = (a: Point, b: Point): Point => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a: Point): Point => {
  const length = Math.hypot(...a) || 1;
  return [a[0] / length, a[1] / length, a[2] / length];
};

/** Adds a round bar between two points, closed at its end `to`. */
export function addRod(builder: MeshBuilder, from: Point, to: Point, radiusM: number, paint: Paint, sidesCount = 4, toRadiusM = radiusM): void {
  const axis = unit(add(to, from, -1));
  const side = unit(cross(axis, Math.abs(axis[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0]));
  const other = cross(axis, side);
  const round = (middle: Point, halfM: number): Point[] =>
    Array.from({ length: sidesCount + 1 }, (_, i) => {
      const angle = (2 * Math.PI * (i % sidesCount)) / sidesCount;
      return add(add(middle, side, halfM * Math.cos(angle)), other, halfM * Math.sin(angle));
    });
  const end = round(to, toRadiusM);
  builder.ring([round(from, radiusM), end], paint);
  builder.grid([end, end.map(() => to)], paint);
}

/** One height of a body of revolution; `paint` is that of the band above it. */
export interface Turn {
  yM: number;
  radiusM: number;
  paint: Paint;
}

/** Adds a body of revolution round an upright axis, open below. */
export function addTurned(builder: MeshBuilder, [xM, baseM, zM]: Point, turns: readonly Turn[], sidesCount: number): void {
  const rows = turns.map(({ yM, radiusM }) =>
    Array.from({ length: sidesCount + 1 }, (_, i): Point => {
      const angle = (-2 * Math.PI * (i % sidesCount)) / sidesCount;
      return [xM + radiusM * Math.cos(angle), baseM + yM, zM + radiusM * Math.sin(angle)];
    }),
  );
  for (let n = 0; n + 1 < turns.length; ++n) builder.ring(rows.slice(n, n + 2), turns[n]!.paint);
}

/**
 * Adds a wall with a window, set in by `deepM`: corners counter-clockwise seen from outside; `frame`: width of the wall round the window,
 * as a share; `reveal`: paint of the sides of the opening.
 */
export function addWindow(builder: MeshBuilder, corners: readonly [Point, Point, Point, Point], frame: { side: number; low: number; high: number }, deepM: number, wall: Paint, glass: Paint, reveal = wall): void {
  const [a, b, c, d] = corners;
  const at = (across: number, up: number): Point => mix(mix(a, b, across), mix(d, c, across), up);
  const outward = unit(cross(add(b, a, -1), add(d, a, -1)));
  const outer = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)];
  const rim = [at(frame.side, frame.low), at(1 - frame.side, frame.low), at(1 - frame.side, 1 - frame.high), at(frame.side, 1 - frame.high)];
  const pane = rim.map((point) => add(point, outward, -deepM));
  for (let n = 0; n < 4; ++n) {
    const next = (n + 1) % 4;
    builder.quad(outer[n]!, outer[next]!, rim[next]!, rim[n]!, wall);
    if (deepM > 0) builder.quad(rim[n]!, rim[next]!, pane[next]!, pane[n]!, reveal);
  }
  builder.quad(pane[0]!, pane[1]!, pane[2]!, pane[3]!, glass);
}

/** Adds a plate: its top's corners, counter-clockwise seen from above. */
export function addPlate(builder: MeshBuilder, top: readonly [Point, Point, Point, Point], thickM: number, paint: Paint): void {
  const low = top.map(([x, y, z]): Point => [x, y - thickM, z]);
  builder.quad(...(top as [Point, Point, Point, Point]), paint);
  for (let n = 0; n < 4; ++n) builder.quad(low[n]!, low[(n + 1) % 4]!, top[(n + 1) % 4]!, top[n]!, paint);
}

/** Adds four upright faces around a rectangle, seen from one side: `inward` from inside. */
export function addWalls(builder: MeshBuilder, half: readonly [number, number], lowM: number, highM: number, inward: boolean, paint: Paint): void {
  const [x, z] = half;
  const corners: [number, number][] = [[-x, z], [x, z], [x, -z], [-x, -z]];
  corners.forEach(([ax, az], i) => {
    const [bx, bz] = corners[(i + 1) % 4]!;
    const from: Point[] = inward ? [[bx, lowM, bz], [ax, lowM, az]] : [[ax, lowM, az], [bx, lowM, bz]];
    builder.quad(from[0]!, from[1]!, [from[1]![0], highM, from[1]![2]], [from[0]![0], highM, from[0]![2]], paint);
  });
}

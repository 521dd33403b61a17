// The hull of a boat as one closed surface: outside (sides, transom, gunwale) and inside (inner sides, deck or floor boards), which share
// the edges of the gunwale.
import { mixPaint, shaded } from "../landscape/paints";
import { clamp } from "../maths/interpolate";
import { hash } from "../maths/random";
import type { MeshBuilder, Band, Paint, Point } from "../meshes/mesh_builder";
import type { HullLines } from "./lines";
import type { Livery } from "./livery";

/** Stations along the hull: denser toward the ends, where the lines bend. */
export function stationsOf(lines: HullLines, count: number): number[] {
  const even = Array.from({ length: count }, (_, i) => i / (count - 1));
  const bent = even.map((share) => 0.35 * share + 0.65 * (0.5 - 0.5 * Math.cos(Math.PI * share)));
  // One of them at the greatest beam.
  const nearest = bent.reduce((best, along, i) => (Math.abs(along - lines.widestAt) < Math.abs(bent[best]! - lines.widestAt) ? i : best), 0);
  bent[nearest] = lines.widestAt;
  return bent;
}

export const mirrored = ([x, y, z]: Point): Point => [x, y, -z];
const middle = (a: Point): Point => [a[0], a[1], 0];

/** What sea water and weather leave on paint. */
const kGrime: Paint = [0.13, 0.12, 0.09, 0];

/** Returns a band whose paint is uneven, grimy at its lower edge and in the strake's shade at its upper one. */
function weathered({ paint, ...band }: Band): Band {
  const last = band.to - band.from;
  const at = (row: number, column: number): Paint => shaded(mixPaint(paint as Paint, kGrime, (row === 0 ? 0.22 : 0.06) * (0.4 + 1.2 * hash(row, column, 81))), row === last && last > 1 ? 0.8 : 1);
  return { ...band, paint: at };
}

/** One row of points from stern to stem: its height between keel (0) and sheer (1) at a station, and how far it stands out. */
interface Level {
  up: (along: number) => number;
  outM: number;
}

/** Returns the rows of the outer side to starboard, and their bands. */
function outerLevels(lines: HullLines, livery: Livery, rowsCount: number): { levels: Level[]; bands: Band[] } {
  const { kind, waterlineM, strakeM, boat } = lines;
  // A horizontal line, kept between bounds where the keel rises to it.
  const level = (yM: number, least: number, most: number) => (along: number): number => {
    const keelM = lines.keelM(along);
    return clamp((yM - keelM) / (lines.sheerM(along) - keelM), least, most);
  };
  const stripeLow = level(waterlineM + 0.01 * boat.heightM, 0.06, 0.78);
  const stripeHigh = level(waterlineM + 0.07 * boat.heightM, 0.09, 0.82);
  const deckAt = (along: number): number => (lines.deckM(along) - lines.keelM(along)) / (lines.sheerM(along) - lines.keelM(along));
  const strake = kind === "dinghy" ? 0.075 : 0.09;
  const strakeLow = (along: number): number => deckAt(along) - strake;
  const between = (low: Level["up"], high: Level["up"], share: number) => (along: number): number => low(along) + share * (high(along) - low(along));

  const levels: Level[] = [];
  const bands: Band[] = [];
  const put = (paint: Paint, isSharp: boolean, rows: Level[]): void => {
    const from = levels.length - 1;
    levels.push(...rows);
    bands.push({ from, to: levels.length - 1, paint, isSharp });
  };
  levels.push({ up: () => 0, outM: 0 });
  const bottom = Array.from({ length: rowsCount }, (_, i) => ((i + 1) / rowsCount) ** 1.5);
  put(livery.bottom, false, bottom.map((share) => ({ up: between(() => 0, stripeLow, share), outM: 0 })));
  put(livery.stripe, false, [{ up: stripeHigh, outM: 0 }]);
  if (kind === "dinghy") {
    // Three planks that overlap like tiles.
    for (let plank = 1; plank <= 3; ++plank) {
      const isTop = plank === 3;
      const top = isTop ? strakeLow : between(stripeHigh, strakeLow, plank / 3);
      put(livery.side, false, [{ up: top, outM: isTop ? 0 : 0.45 * strakeM }]);
      if (!isTop) put(livery.side, true, [{ up: between(stripeHigh, strakeLow, plank / 3 + 0.012), outM: 0 }]);
    }
  } else {
    const sideRows = Math.max(rowsCount - 1, 2);
    put(livery.side, false, Array.from({ length: sideRows }, (_, i) => ({ up: between(stripeHigh, strakeLow, (i + 1) / sideRows), outM: 0 })));
  }
  put(livery.strake, true, [{ up: between(strakeLow, deckAt, 0.25), outM: strakeM }]);
  put(livery.strake, false, [{ up: deckAt, outM: strakeM }]);
  if (kind === "cutter") {
    put(livery.strake, true, [{ up: deckAt, outM: 0 }]);
    put(livery.side, true, [{ up: () => 1, outM: 0 }]);
  }
  return { levels, bands };
}

/** Adds the sides and the transom. Returns the gunwale's outer edge to starboard, from stern to stem. */
export function addOutside(builder: MeshBuilder, lines: HullLines, livery: Livery, stations: readonly number[], rowsCount: number): Point[] {
  const { levels, bands } = outerLevels(lines, livery, rowsCount);
  const rows = levels.map(({ up, outM }) =>
    stations.map((along) => {
      const keelM = lines.keelM(along);
      const share = up(along);
      const [x, y, z] = lines.outside(along, keelM + share * (lines.sheerM(along) - keelM), outM);
      return share === 0 ? ([x, y, 0] as Point) : ([x, y, z] as Point);
    }),
  );
  const worn = bands.map(weathered);
  builder.bands(rows, worn);
  builder.bands(rows.map((row) => row.map(mirrored).reverse()), worn);
  const transom = rows.map(([point]): Point[] => [mirrored(point!), middle(point!), point!]);
  builder.bands(transom, bands.map((band) => weathered(band.paint === livery.side ? { ...band, paint: livery.transom } : band)));
  return rows.at(-1)!;
}

/** A part of the inside's floor: its height over the stations from `from` to `to`, and its paint. */
export interface Floor {
  from: number;
  to: number;
  heightM: (along: number) => number;
  paint: Paint;
  /** Height of the middle over the edges, in beams. */
  camber: number;
}

/**
 * Adds the gunwale's top, the inner sides and the floors, which follow each other from stern to stem without a gap. Returns the gunwale's
 * inner edge to starboard.
 */
export function addInside(builder: MeshBuilder, lines: HullLines, livery: Livery, stations: readonly number[], edge: readonly Point[], floors: readonly Floor[]): Point[] {
  const rims: Point[] = [];
  const walls: Point[][] = [[], [], []];
  const outer: Point[] = [];
  const decks: { rows: Point[][]; floor: Floor }[] = [];
  for (const floor of floors) {
    // Stations where one floor ends and the next begins belong to both: the step between them is a bulkhead.
    const own = stations.map((along, i) => ({ along, i })).filter(({ along }) => along >= floor.from - 1e-9 && along <= floor.to + 1e-9);
    const rows: Point[][] = [];
    for (const { along, i } of own) {
      const isTip = i === stations.length - 1;
      const sheerM = lines.sheerM(along);
      const floorM = clamp(floor.heightM(along), lines.keelM(along) + 0.06 * lines.boat.heightM, sheerM - 0.01 * lines.boat.heightM);
      const rim = isTip ? edge[i]! : lines.inside(along, sheerM);
      outer.push(edge[i]!);
      rims.push(rim);
      const at = (share: number): Point => lines.inside(along, floorM + share * (sheerM - floorM));
      const low = at(0);
      walls[0]!.push(low);
      walls[1]!.push(at(0.5));
      walls[2]!.push(rim);
      rows.push([mirrored(low), [low[0], low[1] + floor.camber * low[2], 0], low]);
    }
    decks.push({ rows, floor });
  }
  const flip = (row: readonly Point[]): Point[] => row.map(mirrored);
  const back = (row: readonly Point[]): Point[] => [...row].reverse();
  builder.grid([flip(rims), flip(outer)], livery.gunwale);
  builder.grid([outer, rims], livery.gunwale);
  // Less light comes down to the floor, least into its corners.
  const shade = (row: number): Paint => shaded(livery.inside, 0.5 + 0.25 * row);
  builder.grid(walls.map(back), shade);
  builder.grid(walls.map(flip), shade);
  const across = (point: Point): Point[] => [point, middle(point), mirrored(point)];
  builder.grid([across(rims[0]!), across(outer[0]!)], livery.gunwale);
  const sternRows = walls.map((row) => across(row[0]!));
  sternRows[0] = [...decks[0]!.rows[0]!].reverse();
  builder.grid(sternRows, shade);
  decks.forEach(({ rows, floor }, n) => {
    builder.grid(rows, (row, column) => shaded(floor.paint, (column === 1 ? 1 : 0.6) * (0.86 + 0.14 * hash(row, column, 82))));
    const next = decks[n + 1];
    if (next) builder.grid([rows.at(-1)!, next.rows[0]!], livery.inside);
  });
  return rims;
}

// Where the volume of the particles' density lies and how its cells lie in a texture: horizontal slices, side by side in rows. Pure.

type Triple = [number, number, number];

/** The volume, m, and its texture. */
export interface VolumeShape {
  minM: Triple;
  /** The last cells may end beyond it. */
  maxM: Triple;
  cellM: number;
  /** Along x, y, z; y is up. */
  cellsCount: Triple;
  slicesPerRow: number;
  widthPx: number;
  heightPx: number;
}

/** Of a tank: length and width, centred, and its floor, m. */
export interface TankBox {
  sideM: number;
  widthM: number;
  floorM: number;
}

/** Larger volumes have larger cells: about so many are the most. */
export const kMostCellsCount = 1_500_000;

/**
 * Returns the volume around particles between `minM` and `maxM`, as far as a kernel of `reachM` reaches. `finestM`: side of a cell, unless
 * there would be too many. In a tank its sides and floor are those of the tank; elsewhere (undefined) the cells keep their places when the
 * particles move, so that the surface does not tremble.
 */
export function volumeShape(minM: Triple, maxM: Triple, reachM: number, finestM: number, tank: TankBox | undefined): VolumeShape {
  const low: Triple = tank ? [-tank.sideM / 2, tank.floorM, -tank.widthM / 2] : [minM[0] - reachM, minM[1] - reachM, minM[2] - reachM];
  const high: Triple = tank ? [tank.sideM / 2, maxM[1] + reachM, tank.widthM / 2] : [maxM[0] + reachM, maxM[1] + reachM, maxM[2] + reachM];
  const lengths = low.map((at, axis) => Math.max(high[axis]! - at, finestM));
  const cellM = Math.max(finestM, Math.cbrt((lengths[0]! * lengths[1]! * lengths[2]!) / kMostCellsCount));
  const from = (tank ? low : low.map((at) => Math.floor(at / cellM) * cellM)) as Triple;
  const cellsCount = from.map((at, axis) => Math.max(Math.ceil((high[axis]! - at) / cellM - 1e-3), 2)) as Triple;
  const [x, y, z] = cellsCount;
  const slicesPerRow = Math.max(Math.ceil(Math.sqrt((y * z) / x)), 1);
  return { minM: from, maxM: high, cellM, cellsCount, slicesPerRow, widthPx: slicesPerRow * x, heightPx: Math.ceil(y / slicesPerRow) * z };
}

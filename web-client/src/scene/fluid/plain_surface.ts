// The surface of a tank's particles as a mesh of few triangles, for the tier minimal: a coarse grid of their density on the CPU, and one
// vertex in each cell that the surface crosses ("naive surface nets", Gibson 1998). Each vertex knows how much water lies behind it for the
// eye, so that a pixel has nothing to search for. Pure.
import { forEachPlace, kWordsPerParticle, whiteOf, type ShownParticles } from "../frames/particle_values";
import type { TankBox } from "./volume_shape";

/** Radius of a particle's kernel in spacings of the particles at rest, and the integral of (1 - r^2)^3 over the unit ball. */
const kReachSpacings = 2.5;
const kKernelIntegral = 0.6383;
/** The density at the surface, over that at rest: that of a filament of particles, as in fluid_volume.glsl. */
const kSurface = 0.36;
/** Bounds of the work: cells of the grid, and particles that are added to it; of more every second, third, ... counts for all. */
export const kMostCellsCount = 40_000;
export const kMostAddedCount = 12_000;
export const kMostDropsCount = 4000;
const kDropsPerParticle = 3;
/** Drops lie so many radii around their particle, and are so large. */
const kDropSpreadRadii = 1.6;
const kDropRadii = { least: 0.1, most: 0.42 };
/** Steps of a ray through the water, of the length of a cell. */
const kMostSteps = 28;
const kFromAir = 0.75;
/** Floats per vertex: position [m], normal, length of the water behind it [m], white share. Of a drop: position, radius [m], white share. */
export const kVertexFloats = 8;
export const kDropFloats = 5;

/** Share of a kernel on this side of a wall, at a distance in its radii (fluid_volume.frag). */
function uncut(away: number): number {
  const left = Math.min(Math.max(1 - away, 0), 1);
  return 1 - 0.5 * left ** 3;
}

/** A number of 0 to 1 for each of the inputs, always the same. */
function scatter(a: number, b: number): number {
  const mixed = Math.sin(a * 127.1 + b * 311.7) * 43758.5453;
  return mixed - Math.floor(mixed);
}

export class PlainSurface {
  vertices = new Float32Array(kVertexFloats * 1024);
  verticesCount = 0;
  indices = new Uint32Array(6 * 1024);
  indicesCount = 0;
  readonly drops = new Float32Array(kDropFloats * kMostDropsCount);
  dropsCount = 0;
  /** Lowest corner of the grid and the sides of its cells, m. */
  private readonly lowM: [number, number, number] = [0, 0, 0];
  private readonly cellM: [number, number, number] = [1, 1, 1];
  /** Corners of cells along x, y, z, with an empty one around the tank. */
  private countX = 0;
  private countY = 0;
  private countZ = 0;
  private density = new Float32Array(0);
  private white = new Float32Array(0);
  private vertexOf = new Uint32Array(0);
  private reachM = 1;

  /** Makes the mesh of these particles in a tank, as it is seen from `eyeM`. */
  build(shown: ShownParticles, maxYM: number, tank: TankBox, eyeM: readonly [number, number, number]): void {
    const stride = Math.ceil(shown.frame.count / kMostAddedCount);
    const spacingM = 2 * shown.frame.radiusM * Math.cbrt(stride);
    this.reachM = kReachSpacings * spacingM;
    this.place(tank, maxYM, spacingM);
    this.add(shown, stride);
    this.mendWalls();
    this.findVertices();
    this.connect();
    this.measure(eyeM);
    this.findDrops(shown);
  }

  /** Returns the length of the water from a point along a unit vector, m, in steps of a cell's shortest side. */
  lengthM(x: number, y: number, z: number, dx: number, dy: number, dz: number): number {
    const { lowM, cellM, countX, countY, countZ, density } = this;
    const stepM = Math.min(...cellM);
    let inside = 0;
    for (let step = 1; step <= kMostSteps; ++step) {
      const away = (step - 0.5) * stepM;
      const i = Math.round((x + dx * away - lowM[0]) / cellM[0]);
      const j = Math.round((y + dy * away - lowM[1]) / cellM[1]);
      const k = Math.round((z + dz * away - lowM[2]) / cellM[2]);
      if (i < 1 || j < 1 || k < 1 || i > countX - 2 || j > countY - 2 || k > countZ - 2) continue;
      if (density[(j * countZ + k) * countX + i]! > kSurface) ++inside;
    }
    return inside * stepM;
  }

  /** Lays the grid into the tank: its sides and floor pass through corners of cells. */
  private place({ sideM, widthM, floorM }: TankBox, maxYM: number, spacingM: number): void {
    const sizes = [sideM, Math.max(maxYM + this.reachM - floorM, spacingM), widthM] as const;
    const finestM = Math.max(spacingM, Math.cbrt((sizes[0] * sizes[1] * sizes[2]) / kMostCellsCount) * 1.25);
    const cells = sizes.map((size) => Math.min(Math.max(Math.round(size / finestM), 2), 400)) as [number, number, number];
    for (let axis = 0; axis < 3; ++axis) this.cellM[axis] = sizes[axis]! / cells[axis]!;
    this.lowM[0] = -sideM / 2 - this.cellM[0];
    this.lowM[1] = floorM - this.cellM[1];
    this.lowM[2] = -widthM / 2 - this.cellM[2];
    [this.countX, this.countY, this.countZ] = [cells[0] + 3, cells[1] + 3, cells[2] + 3];
    const count = this.countX * this.countY * this.countZ;
    if (this.density.length < count) {
      this.density = new Float32Array(count);
      this.white = new Float32Array(count);
      this.vertexOf = new Uint32Array(count);
    } else {
      this.density.fill(0, 0, count);
      this.white.fill(0, 0, count);
    }
  }

  /** Adds every `stride`-th particle to the corners that its kernel reaches. */
  private add(shown: ShownParticles, stride: number): void {
    const { lowM, cellM, countX, countY, countZ, density, white, reachM } = this;
    const [sx, sy, sz] = [1 / cellM[0], 1 / cellM[1], 1 / cellM[2]];
    const [qx, qy, qz] = [(cellM[0] / reachM) ** 2, (cellM[1] / reachM) ** 2, (cellM[2] / reachM) ** 2];
    const [rx, ry, rz] = [reachM * sx, reachM * sy, reachM * sz];
    const scale = 1 / (kKernelIntegral * kReachSpacings ** 3);
    forEachPlace(shown, stride, (n, xM, yM, zM) => {
      const [x, y, z] = [(xM - lowM[0]) * sx, (yM - lowM[1]) * sy, (zM - lowM[2]) * sz];
      const foam = whiteOf(shown, n) / 255;
      const share = foam > 0.45 ? Math.min((foam - 0.45) / 0.55, 1) : 0;
      const toX = Math.min(Math.floor(x + rx), countX - 2);
      const toY = Math.min(Math.floor(y + ry), countY - 2);
      const toZ = Math.min(Math.floor(z + rz), countZ - 2);
      const fromX = Math.max(Math.ceil(x - rx), 1);
      for (let j = Math.max(Math.ceil(y - ry), 1); j <= toY; ++j) {
        const leftY = 1 - qy * (j - y) * (j - y);
        for (let k = Math.max(Math.ceil(z - rz), 1); k <= toZ; ++k) {
          const leftYz = leftY - qz * (k - z) * (k - z);
          if (leftYz <= 0) continue;
          const row = (j * countZ + k) * countX;
          for (let i = fromX; i <= toX; ++i) {
            const left = leftYz - qx * (i - x) * (i - x);
            if (left <= 0) continue;
            const weight = scale * left * left * left;
            density[row + i]! += weight;
            white[row + i]! += weight * share;
          }
        }
      }
    });
  }

  /** Beside walls and over the floor the part of the kernel behind them is added to the rest, so that water meets the glass at its own height. */
  private mendWalls(): void {
    const { countX, countY, countZ, cellM, reachM, density, white } = this;
    const along = (count: number, cell: number, hasEnd: boolean): number[] =>
      Array.from({ length: count }, (_, n) => {
        const away = ((n - 1) * cell) / reachM;
        const left = ((count - 2 - n) * cell) / reachM;
        return 1 / (uncut(away) * (hasEnd ? uncut(left) : 1));
      });
    const [x, y, z] = [along(countX, cellM[0], true), along(countY, cellM[1], false), along(countZ, cellM[2], true)];
    for (let j = 1; j < countY - 1; ++j)
      for (let k = 1; k < countZ - 1; ++k) {
        const row = (j * countZ + k) * countX;
        const mended = y[j]! * z[k]!;
        for (let i = 1; i < countX - 1; ++i) {
          density[row + i]! *= mended * x[i]!;
          white[row + i]! *= mended * x[i]!;
        }
      }
  }

  /** Puts a vertex into each cell that the surface crosses: the mean of the crossings of its edges, within the tank. */
  private findVertices(): void {
    const { countX, countY, countZ, density, white, vertexOf, lowM, cellM } = this;
    const row = countX;
    const layer = countX * countZ;
    const highs = [countX - 2, countY - 2, countZ - 2] as const;
    this.verticesCount = 0;
    const values = new Float32Array(8);
    for (let j = 0; j < countY - 1; ++j)
      for (let k = 0; k < countZ - 1; ++k)
        for (let i = 0; i < countX - 1; ++i) {
          const at = j * layer + k * row + i;
          let mask = 0;
          for (let c = 0; c < 8; ++c) {
            const value = density[at + (c & 1) + (c & 2 ? layer : 0) + (c & 4 ? row : 0)]!;
            values[c] = value;
            if (value > kSurface) mask |= 1 << c;
          }
          if (mask === 0 || mask === 255) continue;
          let [sx, sy, sz, crossings] = [0, 0, 0, 0];
          for (let a = 0; a < 8; ++a)
            for (let bit = 1; bit < 8; bit <<= 1) {
              if (a & bit || ((mask >> a) & 1) === ((mask >> (a | bit)) & 1)) continue;
              const share = (kSurface - values[a]!) / (values[a | bit]! - values[a]!);
              sx += (a & 1) + (bit === 1 ? share : 0);
              sy += (a & 2) / 2 + (bit === 2 ? share : 0);
              sz += (a & 4) / 4 + (bit === 4 ? share : 0);
              ++crossings;
            }
          const [v0, v1, v2, v3, v4, v5, v6, v7] = values as unknown as [number, number, number, number, number, number, number, number];
          const gx = (v0 + v2 + v4 + v6 - v1 - v3 - v5 - v7) / cellM[0];
          const gy = (v0 + v1 + v4 + v5 - v2 - v3 - v6 - v7) / cellM[1];
          const gz = (v0 + v1 + v2 + v3 - v4 - v5 - v6 - v7) / cellM[2];
          const per = 1 / Math.max(Math.hypot(gx, gy, gz), 1e-6);
          vertexOf[at] = this.verticesCount;
          const out = this.reserveVertex();
          const { vertices } = this;
          vertices[out] = lowM[0] + cellM[0] * Math.min(Math.max(i + sx / crossings, 1), highs[0]);
          vertices[out + 1] = lowM[1] + cellM[1] * Math.min(Math.max(j + sy / crossings, 1), highs[1]);
          vertices[out + 2] = lowM[2] + cellM[2] * Math.min(Math.max(k + sz / crossings, 1), highs[2]);
          vertices[out + 3] = gx * per;
          vertices[out + 4] = gy * per;
          vertices[out + 5] = gz * per;
          let [most, whitest] = [1e-3, 0];
          for (let c = 0; c < 8; ++c) {
            const corner = at + (c & 1) + (c & 2 ? layer : 0) + (c & 4 ? row : 0);
            most += density[corner]!;
            whitest += white[corner]!;
          }
          vertices[out + 7] = whitest / most;
        }
  }

  /** Joins the vertices of the four cells around each edge that the surface crosses, counter-clockwise as seen from the air. */
  private connect(): void {
    const { countX, countY, countZ, density } = this;
    const row = countX;
    const layer = countX * countZ;
    this.indicesCount = 0;
    for (let j = 0; j < countY - 1; ++j)
      for (let k = 0; k < countZ - 1; ++k)
        for (let i = 0; i < countX - 1; ++i) {
          const at = j * layer + k * row + i;
          const isIn = density[at]! > kSurface;
          if (j > 0 && k > 0 && density[at + 1]! > kSurface !== isIn) this.quad(at, layer, row, isIn);
          if (i > 0 && k > 0 && density[at + layer]! > kSurface !== isIn) this.quad(at, row, 1, isIn);
          if (i > 0 && j > 0 && density[at + row]! > kSurface !== isIn) this.quad(at, 1, layer, isIn);
        }
  }

  /** `u`, `v`: steps between cells along the two axes across an edge, of which a right-handed system has the edge as the third. */
  private quad(at: number, u: number, v: number, isFirstIn: boolean): void {
    const { vertexOf } = this;
    if (this.indices.length < this.indicesCount + 6) {
      const grown = new Uint32Array(2 * this.indices.length);
      grown.set(this.indices);
      this.indices = grown;
    }
    const { indices } = this;
    const [a, b, c, d] = [vertexOf[at]!, vertexOf[at - u]!, vertexOf[at - u - v]!, vertexOf[at - v]!];
    let n = this.indicesCount;
    this.indicesCount += 6;
    const [second, fourth] = isFirstIn ? [b, d] : [d, b];
    indices[n++] = a;
    indices[n++] = second;
    indices[n++] = c;
    indices[n++] = a;
    indices[n++] = c;
    indices[n] = fourth;
  }

  /** Measures the water behind each vertex along the refracted ray from the eye. */
  private measure([ex, ey, ez]: readonly [number, number, number]): void {
    const { vertices } = this;
    for (let at = 0; at < kVertexFloats * this.verticesCount; at += kVertexFloats) {
      const [x, y, z] = [vertices[at]!, vertices[at + 1]!, vertices[at + 2]!];
      const [nx, ny, nz] = [vertices[at + 3]!, vertices[at + 4]!, vertices[at + 5]!];
      const per = 1 / Math.max(Math.hypot(x - ex, y - ey, z - ez), 1e-6);
      const [rx, ry, rz] = [(x - ex) * per, (y - ey) * per, (z - ez) * per];
      const facing = -(rx * nx + ry * ny + rz * nz);
      vertices[at + 6] = 0;
      // What faces away is not drawn.
      if (facing <= -0.2) continue;
      const cos = Math.max(facing, 0);
      const bent = kFromAir * cos - Math.sqrt(1 - kFromAir * kFromAir * (1 - cos * cos));
      vertices[at + 6] = this.lengthM(x, y, z, kFromAir * rx + bent * nx, kFromAir * ry + bent * ny, kFromAir * rz + bent * nz);
    }
  }

  /** Particles outside of the surface are a few drops each, the same ones as long as their level velocity stays. */
  private findDrops(shown: ShownParticles): void {
    const { lowM, cellM, countX, countY, countZ, density, drops } = this;
    const { radiusM } = shown.frame;
    this.dropsCount = 0;
    forEachPlace(shown, 1, (n, x, y, z) => {
      if (this.dropsCount + kDropsPerParticle > kMostDropsCount) return;
      const i = Math.round((x - lowM[0]) / cellM[0]);
      const j = Math.round((y - lowM[1]) / cellM[1]);
      const k = Math.round((z - lowM[2]) / cellM[2]);
      if (i < 1 || j < 1 || k < 1 || i > countX - 2 || j > countY - 2 || k > countZ - 2) return;
      if (density[(j * countZ + k) * countX + i]! > kSurface) return;
      const level = shown.words[n * kWordsPerParticle + 3]!;
      for (let drop = 0; drop < kDropsPerParticle; ++drop) {
        const seed = level + 0.37 * drop;
        const size = scatter(seed, 4);
        const out = kDropFloats * this.dropsCount++;
        drops[out] = x + kDropSpreadRadii * radiusM * (2 * scatter(seed, 1) - 1);
        drops[out + 1] = y + kDropSpreadRadii * radiusM * (2 * scatter(seed, 2) - 1);
        drops[out + 2] = z + kDropSpreadRadii * radiusM * (2 * scatter(seed, 3) - 1);
        drops[out + 3] = radiusM * (kDropRadii.least + (kDropRadii.most - kDropRadii.least) * size * size);
        drops[out + 4] = whiteOf(shown, n) / 255;
      }
    });
  }

  private reserveVertex(): number {
    const at = kVertexFloats * this.verticesCount++;
    if (at + kVertexFloats > this.vertices.length) {
      const grown = new Float32Array(2 * this.vertices.length);
      grown.set(this.vertices);
      this.vertices = grown;
    }
    return at;
  }
}

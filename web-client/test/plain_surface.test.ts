// The mesh of a tank's particles in the tier minimal.
import { describe, expect, it } from "vitest";

import { kMostAddedCount, kMostCellsCount, kMostDropsCount, kVertexFloats, PlainSurface } from "../src/scene/fluid/plain_surface";
import type { ShownParticles } from "../src/scene/frames/particle_values";

type Triple = [number, number, number];
const kTank = { sideM: 4, widthM: 0.8, floorM: 0 };
const kRadiusM = 0.04;
const kLow: Triple = [-2, 0, -0.4];
const kHigh: Triple = [2, 2, 0.4];

/** Particles at these positions, at rest. */
function shown(places: readonly Triple[], radiusM = kRadiusM): ShownParticles {
  const words = new Uint16Array(6 * places.length);
  places.forEach(([x, y, z], at) => {
    const [u, v, w] = [x, y, z].map((place, axis) => Math.round((65535 * (place - kLow[axis]!)) / (kHigh[axis]! - kLow[axis]!))) as Triple;
    words.set([u, w, v], 6 * at);
  });
  return { frame: { count: places.length, wordMinM: kLow, wordMaxM: kHigh, maxSpeedMps: 1, radiusM }, words, advanceS: 0 };
}

/** A block of water from the left wall, as deep as wide as given. */
function block(lengthM: number, depthM: number, spacingM = 2 * kRadiusM): Triple[] {
  const places: Triple[] = [];
  for (let x = -2 + spacingM / 2; x < -2 + lengthM; x += spacingM)
    for (let y = spacingM / 2; y < depthM; y += spacingM) for (let z = -0.4 + spacingM / 2; z < 0.4; z += spacingM) places.push([x, y, z]);
  return places;
}

function build(particles: ShownParticles, eyeM: Triple = [0, 1, 6]): PlainSurface {
  const surface = new PlainSurface();
  surface.build(particles, kHigh[1], kTank, eyeM);
  return surface;
}

/** Volume that the mesh encloses: positive if its triangles are counter-clockwise from outside. */
function volumeM3({ vertices, indices, indicesCount }: PlainSurface): number {
  const at = (n: number): Triple => [0, 1, 2].map((axis) => vertices[kVertexFloats * indices[n]! + axis]!) as Triple;
  let sum = 0;
  for (let n = 0; n < indicesCount; n += 3) {
    const [a, b, c] = [at(n), at(n + 1), at(n + 2)];
    sum += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6;
  }
  return sum;
}

describe("the mesh of a tank's particles", () => {
  it("encloses the water, and touches the walls and the floor", () => {
    const surface = build(shown(block(1, 1.2)));
    expect(volumeM3(surface)).toBeGreaterThan(0.9 * 0.96);
    expect(volumeM3(surface)).toBeLessThan(1.12 * 0.96);
    const along = (axis: number): number[] => Array.from({ length: surface.verticesCount }, (_, n) => surface.vertices[kVertexFloats * n + axis]!);
    expect(Math.min(...along(0))).toBeCloseTo(-2, 5);
    expect(Math.min(...along(1))).toBeCloseTo(0, 5);
    expect(Math.min(...along(2))).toBeCloseTo(-0.4, 5);
    expect(Math.max(...along(2))).toBeCloseTo(0.4, 5);
  });

  it("is closed: each edge belongs to two triangles, once in each direction", () => {
    const { indices, indicesCount } = build(shown(block(1, 1.2)));
    const edges = new Map<string, number>();
    for (let n = 0; n < indicesCount; n += 3)
      for (let k = 0; k < 3; ++k) {
        const [a, b] = [indices[n + k]!, indices[n + ((k + 1) % 3)]!];
        const key = a < b ? `${a} ${b}` : `${b} ${a}`;
        edges.set(key, (edges.get(key) ?? 0) + (a < b ? 1 : -1));
      }
    expect(edges.size).toBeGreaterThan(1000);
    expect([...edges.values()].every((sum) => sum === 0)).toBe(true);
  });

  it("knows the length of the water behind a pane", () => {
    // The eye looks along z, through a front pane of water 0.8 m wide.
    const surface = build(shown(block(1, 1.2)), [-1.5, 0.6, 30]);
    const lengths: number[] = [];
    for (let at = 0; at < kVertexFloats * surface.verticesCount; at += kVertexFloats) {
      const [x, y, z] = surface.vertices.subarray(at, at + 3);
      if (z! > 0.399 && x! > -1.8 && x! < -1.3 && y! > 0.3 && y! < 0.9) lengths.push(surface.vertices[at + 6]!);
    }
    expect(lengths.length).toBeGreaterThan(10);
    for (const length of lengths) expect(Math.abs(length - 0.8)).toBeLessThan(0.12);
  });

  it("leaves what is apart to drops, the same ones in the next picture", () => {
    const particles = shown([...block(1, 0.8), [1, 1.6, 0]]);
    const surface = build(particles);
    expect(surface.dropsCount).toBe(3);
    const before = surface.drops.slice(0, 15);
    surface.build(particles, kHigh[1], kTank, [1, 1, 5]);
    expect(surface.drops.slice(0, 15)).toEqual(before);
    for (let n = 0; n < 3; ++n) expect(Math.hypot(before[5 * n]! - 1, before[5 * n + 1]! - 1.6, before[5 * n + 2]!)).toBeLessThan(4 * kRadiusM);
    for (let at = 0; at < kVertexFloats * surface.verticesCount; at += kVertexFloats) expect(surface.vertices[at]!).toBeLessThan(0);
  });

  it("is empty without particles, and bounded with many small ones", () => {
    expect(build(shown([])).indicesCount).toBe(0);
    // Too many to be added one by one, each alone by its radius.
    const many = Array.from({ length: 5 * kMostAddedCount }, (_, n): Triple => [-2 + (4 * ((n * 0.618) % 1)), 2 * ((n * 0.414) % 1), -0.4 + 0.8 * ((n * 0.732) % 1)]);
    const surface = build(shown(many, 0.002));
    expect(surface.verticesCount).toBeLessThan(kMostCellsCount);
    expect(surface.dropsCount).toBeLessThanOrEqual(kMostDropsCount);
  });
});

// White water without a renderer: how drops, foam and bubbles move, and where they begin.
import { describe, expect, it } from "vitest";

import type { SurfaceFrame } from "../src/net/messages";
import { makePose } from "../src/scene/frames/bodies";
import { DiffuseParticles, kFloatsPerParticle, kinds, kLandedShare, kMaxStepS, type Birth, type Kind, type Medium } from "../src/scene/whitewater/diffuse_particles";
import { MovingSurface, restingSurface, type Surface } from "../src/scene/whitewater/moving_surface";
import { makeFastRandom } from "../src/scene/maths/random";
import { addCrests, addHulls, addRims, rimOf, sizeRatioOf, type Births } from "../src/scene/whitewater/sources";

const kSideM = 16;
const kCount = 32;
const header = { tick: 0n, stateId: 0n, serverTimeS: 0, level: "full" as const };

function surfaceFrame(timeS: number, elevationM: (xM: number, zM: number) => number): SurfaceFrame {
  const samples = new Int16Array(kCount * kCount);
  const at = (i: number): number => ((i + 0.5) / kCount - 0.5) * kSideM;
  samples.forEach((_, n) => (samples[n] = Math.round(elevationM(at(n % kCount), at(Math.floor(n / kCount))) * 1000)));
  return { ...header, layer: "surface", timeS, resolutionCount: kCount, countZ: kCount, sideM: kSideM, widthM: kSideM, quantumM: 0.001, buffer: samples.buffer };
}

/** A surface that rises everywhere by `riseMps`, with the slope `slope` along x. */
function moving(riseMps: number, slope = 0): MovingSurface {
  const from = surfaceFrame(0, (xM) => slope * xM);
  const to = surfaceFrame(0.1, (xM) => slope * xM + 0.1 * riseMps);
  return new MovingSurface({ before: undefined, from, to, after: undefined, mix: 0.5 });
}

const kStill: Medium = { elevationAtM: (xM, zM) => (Math.max(Math.abs(xM), Math.abs(zM)) < kSideM / 2 ? 0 : undefined), gravityMps2: 9.81, windMps: { x: 0, z: 0 } };

function births(capacityCount = 20_000): Births {
  const random = makeFastRandom(1);
  return { particles: new DiffuseParticles(capacityCount, random), random, scale: 1, sizeRatio: 1 };
}

const born = (kind: Kind, change: Partial<Birth> = {}): Birth => ({ kind, xM: 0, yM: 0, zM: 0, vxMps: 0, vyMps: 0, vzMps: 0, radiusM: 0.02, lifeS: 10, ...change });

/** Returns the values of one particle: position, kind + age share, velocity, radius. */
const valuesOf = ({ values }: DiffuseParticles, n = 0): number[] => [...values.subarray(n * kFloatsPerParticle, (n + 1) * kFloatsPerParticle)];

describe("a drop", () => {
  it("flies like a thrown body, and a share of the drops becomes foam where they fall", () => {
    const { particles } = births();
    // A large drop feels little drag: 2 m/s up comes down after 2 v / g, 0.41 s, 0.41 m away at 1 m/s.
    for (let n = 0; n < 1000; ++n) particles.add(born(kinds.spray, { yM: 0.001, vxMps: 1, vyMps: 2, radiusM: 0.05 }));
    let highestM = 0;
    let timeS = 0;
    while (particles.countOf(kinds.spray) > 0 && timeS < 2) {
      particles.step(1 / 240, kStill);
      timeS += 1 / 240;
      highestM = Math.max(highestM, particles.values[1]!);
    }
    expect(timeS).toBeGreaterThan(0.38);
    expect(timeS).toBeLessThan(0.43);
    expect(highestM).toBeGreaterThan(0.18);
    expect(highestM).toBeLessThan(0.205);
    expect(particles.count / 1000).toBeGreaterThan(0.7 * kLandedShare);
    expect(particles.count / 1000).toBeLessThan(1.3 * kLandedShare);
    expect(particles.countOf(kinds.foam)).toBe(particles.count);
    expect(particles.values[0]).toBeGreaterThan(0.36);
    expect(particles.values[0]).toBeLessThan(0.42);
    expect(particles.values[1]).toBe(0);
  });

  it("is carried by the wind, the smaller the faster, and never faster than it", () => {
    const { particles } = births();
    for (const radiusM of [0.006, 0.05]) particles.add(born(kinds.spray, { yM: 50, radiusM }));
    const wind: Medium = { ...kStill, elevationAtM: () => 0, windMps: { x: 8, z: 0 } };
    for (let n = 0; n < 20; ++n) particles.step(kMaxStepS, wind);
    const [small, large] = [valuesOf(particles, 0)[4]!, valuesOf(particles, 1)[4]!];
    expect(small).toBeGreaterThan(2 * large);
    expect(small).toBeLessThanOrEqual(8);
    expect(large).toBeGreaterThan(0);
  });
});

describe("bubbles and foam", () => {
  it("rise and burst at the surface", () => {
    const { particles } = births();
    particles.add(born(kinds.bubble, { yM: -0.25 }));
    // 0.25 m at 0.28 m/s.
    for (let n = 0; n < 24; ++n) particles.step(kMaxStepS, kStill);
    expect(particles.countOf(kinds.bubble)).toBe(1);
    for (let n = 0; n < 6; ++n) particles.step(kMaxStepS, kStill);
    expect(particles.count).toBe(0);
  });

  it("float on a surface that moves, and stop where they float", () => {
    const { particles } = births();
    particles.add(born(kinds.foam, { vxMps: 2 }));
    for (let n = 0; n < 120; ++n) particles.step(kMaxStepS, { ...kStill, elevationAtM: () => 0.3 });
    expect(particles.values[1]).toBeCloseTo(0.3, 6);
    expect(Math.abs(particles.values[4]!)).toBeLessThan(0.05);
    // 2 m/s that relax within 0.6 s.
    expect(particles.values[0]).toBeGreaterThan(0.9);
    expect(particles.values[0]).toBeLessThan(1.3);
  });
});

describe("the pool of particles", () => {
  it("never holds more than its capacity, removes what leaves the water, and stays finite", () => {
    const random = makeFastRandom(5);
    const particles = new DiffuseParticles(500, random);
    for (let n = 0; n < 400; ++n) {
      for (let k = 0; k < 40; ++k)
        particles.add(born((k % 3) as Kind, { xM: 16 * (random() - 0.5), zM: 16 * (random() - 0.5), yM: random() - 0.5, vxMps: 40 * (random() - 0.5), vyMps: 8 * random(), lifeS: 0.1 + random(), radiusM: 0.001 + 0.2 * random() }));
      particles.step(kMaxStepS, { ...kStill, windMps: { x: 12, z: -5 } });
      expect(particles.count).toBeLessThanOrEqual(500);
    }
    expect(particles.count).toBeGreaterThan(50);
    for (let n = 0; n < particles.count; ++n) {
      const values = valuesOf(particles, n);
      expect(values.every(Number.isFinite)).toBe(true);
      expect(Math.abs(values[0]!)).toBeLessThanOrEqual(kSideM / 2);
      expect([0, 1, 2]).toContain(Math.floor(values[3]!));
    }
  });
});

describe("the moving surface", () => {
  it("has the elevation, the vertical speed and the slope of its frames", () => {
    const surface = moving(0.8, 0.1);
    const motion = surface.motionAt(1.25, -2.25)!;
    expect(motion.elevationM).toBeCloseTo(0.125 + 0.04, 3);
    expect(motion.riseMps).toBeCloseTo(0.8, 2);
    expect(motion.slopeX).toBeCloseTo(0.1, 2);
    expect(motion.slopeZ).toBeCloseTo(0, 3);
    expect(surface.elevationAtM(1.25, -2.25)).toBeCloseTo(0.165, 3);
    expect(surface.motionAt(8.1, 0)).toBeUndefined();
    expect(surface.elevationAtM(0, -8.1)).toBeUndefined();
  });

  it("stands still with frames of two sizes", () => {
    const from = { ...surfaceFrame(0, () => 1), resolutionCount: 4, countZ: 4 };
    const surface = new MovingSurface({ before: undefined, from, to: surfaceFrame(0.1, () => 0.5), after: undefined, mix: 0.5 });
    expect(surface.motionAt(0, 0)).toEqual({ elevationM: 0.5, riseMps: 0, slopeX: 0, slopeZ: 0, curvaturePerM: 0 });
  });
});

describe("breaking crests", () => {
  /** A ridge along z that travels toward +x at `speedMps`; its top is at x = 0 after the interval of 0.1 s. */
  const ridge = (heightM: number, speedMps: number, halfWidthM = 0.7): MovingSurface => {
    const at = (topM: number) => (xM: number): number => heightM * Math.exp(-(((xM - topM) / halfWidthM) ** 2));
    return new MovingSurface({ before: undefined, from: surfaceFrame(0, at(-0.1 * speedMps)), to: surfaceFrame(0.1, at(0)), after: undefined, mix: 1 });
  };
  const thrownBy = (surface: Surface, change: Partial<Births> = {}, stepS = 0.02): number[][] => {
    const made = { ...births(), ...change };
    for (let n = 0; n < 10; ++n) addCrests(made, surface, stepS);
    return Array.from({ length: made.particles.count }, (_, n) => valuesOf(made.particles, n));
  };
  const kindOf = (values: readonly number[]): number => Math.floor(values[3]!);

  it("throw drops and puffs ahead of their front, with bubbles below", () => {
    const born = thrownBy(ridge(0.6, 2));
    const inAir = born.filter((values) => kindOf(values) !== kinds.bubble);
    const puffs = inAir.filter((values) => kindOf(values) === kinds.puff);
    expect(inAir.length).toBeGreaterThan(500);
    expect(puffs.length / inAir.length).toBeGreaterThan(0.45);
    expect(puffs.length / inAir.length).toBeLessThan(0.55);
    expect(born.length).toBeGreaterThan(inAir.length);
    // Before the top, up to the reach of a front and of its lip.
    for (const [xM] of inAir) {
      expect(xM).toBeGreaterThan(-0.5);
      expect(xM).toBeLessThan(1.5);
    }
    // With about the speed of the ridge.
    const forwardMps = inAir.reduce((sum, values) => sum + values[4]!, 0) / inAir.length;
    expect(forwardMps).toBeGreaterThan(1);
    expect(forwardMps).toBeLessThan(3);
  });

  it("throw as many however long the steps are", () => {
    const once = births();
    addCrests(once, ridge(0.6, 2), 0.2);
    const ratio = once.particles.count / thrownBy(ridge(0.6, 2)).length;
    expect(ratio).toBeGreaterThan(0.9);
    expect(ratio).toBeLessThan(1.1);
  });

  it("throw as many in water of a quarter of the size, a quarter as large", () => {
    expect([0.5, 1, 3, 6, 40].map(sizeRatioOf)).toEqual([0.25, 0.25, 0.5, 1, 1]);
    // Froude's law: lengths a quarter, times and speeds a half.
    const small = (frame: SurfaceFrame): SurfaceFrame => ({ ...frame, timeS: frame.timeS / 2, sideM: kSideM / 4, widthM: kSideM / 4, quantumM: frame.quantumM / 4 });
    const at = (topM: number) => (xM: number): number => 0.6 * Math.exp(-(((xM - topM) / 0.7) ** 2));
    const surface = new MovingSurface({ before: undefined, from: small(surfaceFrame(0, at(-0.2))), to: small(surfaceFrame(0.1, at(0))), after: undefined, mix: 1 });
    const inAir = (born: readonly number[][]): number[][] => born.filter((values) => kindOf(values) !== kinds.bubble);
    const [sea, narrow] = [inAir(thrownBy(ridge(0.6, 2))), inAir(thrownBy(surface, { sizeRatio: 0.25 }, 0.01))];
    const widestM = (born: readonly number[][]): number => Math.max(...born.map((values) => values[7]!));
    expect(narrow.length / sea.length).toBeGreaterThan(0.85);
    expect(narrow.length / sea.length).toBeLessThan(1.15);
    expect(widestM(narrow) / widestM(sea)).toBeGreaterThan(0.2);
    expect(widestM(narrow) / widestM(sea)).toBeLessThan(0.3);
  });

  it("do nothing where the water is round, falls, or stands still", () => {
    expect(thrownBy(ridge(0.6, 2, 5))).toEqual([]);
    expect(thrownBy(moving(-1))).toEqual([]);
    expect(thrownBy(ridge(0.6, 0))).toEqual([]);
    expect(thrownBy(restingSurface(kSideM, kSideM))).toEqual([]);
  });
});

describe("hulls", () => {
  const hulls = new Map([[1, { boatId: 1, lengthM: 2.5, beamM: 1, heightM: 0.8, draughtM: 0.2 }]]);
  const run = (speedMps: number, stepS: number, steps: number, surface: Surface = moving(0)): Births => {
    const made = births();
    for (let n = 0; n < steps; ++n) addHulls(made, [{ ...makePose(), boatId: 1, speedMps }, { ...makePose(), boatId: 9, speedMps: 9 }], hulls, surface, 9.81, stepS);
    return made;
  };

  it("leave foam at the resting level of particles, as far as their water reaches", () => {
    const { particles } = run(2, 0.05, 20, restingSurface(kSideM, kSideM));
    expect(particles.countOf(kinds.foam)).toBeGreaterThan(20);
    for (let n = 0; n < particles.count; ++n) if (Math.floor(valuesOf(particles, n)[3]!) === kinds.foam) expect(valuesOf(particles, n)[1]).toBe(0);
    expect(run(2, 0.05, 20, restingSurface(1, 1)).particles.count).toBe(0);
  });

  it("throw more spray the faster they are, none when slow, and leave foam behind them", () => {
    expect(run(0.9, 0.05, 20).particles.countOf(kinds.spray)).toBe(0);
    const [slow, fast] = [run(3, 0.05, 20).particles, run(4.5, 0.05, 20).particles];
    expect(slow.countOf(kinds.spray)).toBeGreaterThan(20);
    expect(fast.countOf(kinds.spray)).toBeGreaterThan(2 * slow.countOf(kinds.spray));
    expect(run(0, 0.05, 20).particles.count).toBe(0);
    let asternCount = 0;
    for (let n = 0; n < fast.count; ++n) {
      const [xM, , zM, kindAge] = valuesOf(fast, n);
      const kind = Math.floor(kindAge!);
      // Spray at the bow (+x), bubbles at the stern, foam from the stem to where the stern was a step before.
      if (kind === kinds.spray) expect(xM).toBeGreaterThan(0);
      if (kind === kinds.bubble) expect(xM).toBeLessThan(-1.2);
      expect(xM).toBeGreaterThan(-1.25 - 4.5 * 0.05 - 0.01);
      expect(Math.abs(zM!)).toBeLessThan(0.601);
      if (kind === kinds.foam) asternCount += Number(xM! < -1.2);
    }
    expect(asternCount).toBeGreaterThan(20);
    expect(fast.countOf(kinds.foam) - asternCount).toBeGreaterThan(asternCount);
  });

  it("throw the same number per second at any rate of pictures", () => {
    const [often, seldom] = [run(4, 1 / 60, 120).particles.count, run(4, 1 / 10, 20).particles.count];
    expect(often / seldom).toBeGreaterThan(0.75);
    expect(often / seldom).toBeLessThan(1.33);
  });
});

describe("the water lines of obstacles", () => {
  const obstacles = [
    { shape: "rock", xM: 2, zM: 1, radiusM: 1, heightM: 1 },
    { shape: "breakwater", xM: -3, zM: 0, lengthM: 6, widthM: 1, headingRad: Math.PI / 2, heightM: 1 },
  ] as const;
  const rim = rimOf(obstacles);

  it("have their length, and normals that point away from them", () => {
    const lengthOf = (from: number, to: number): number => rim.slice(from, to).reduce((sum, { lengthM }) => sum + lengthM, 0);
    const rockCount = rim.findIndex(({ xM }) => xM < 0);
    expect(lengthOf(0, rockCount)).toBeCloseTo(2 * Math.PI * 1.15, 6);
    expect(lengthOf(rockCount, rim.length)).toBeCloseTo(14, 6);
    rim.forEach(({ xM, zM, normalX, normalZ }, n) => {
      const middle = n < rockCount ? obstacles[0] : obstacles[1];
      expect(Math.hypot(normalX, normalZ)).toBeCloseTo(1, 6);
      expect((xM - middle.xM) * normalX + (zM - middle.zM) * normalZ).toBeGreaterThan(0.5);
      if (n >= rockCount) expect(Math.abs(xM - middle.xM) < 0.66 && Math.abs(zM) < 3.16).toBe(true);
    });
  });

  it("throw drops and puffs up and outward where the surface rises fast, and none where it falls", () => {
    const calm = births();
    addRims(calm, rim, moving(-2), 0.1);
    addRims(calm, rim, moving(0.2), 0.1);
    expect(calm.particles.count).toBe(0);
    const made = births();
    addRims(made, rim, moving(2), 0.1);
    expect(made.particles.countOf(kinds.spray)).toBeGreaterThan(100);
    expect(made.particles.countOf(kinds.puff)).toBeGreaterThan(100);
    for (let n = 0; n < made.particles.count; ++n) {
      const values = valuesOf(made.particles, n);
      if (Math.floor(values[3]!) !== kinds.foam) expect(values[5]).toBeGreaterThan(2);
    }
  });

  it("are bounded for a scene with very many obstacles", () => {
    expect(rimOf(Array.from({ length: 64 }, () => ({ shape: "rock", xM: 0, zM: 0, radiusM: 1e5, heightM: 1 }) as const)).length).toBeLessThanOrEqual(4000);
  });
});

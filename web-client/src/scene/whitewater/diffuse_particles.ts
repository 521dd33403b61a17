// White water that is not simulated by the server: drops and puffs of fine ones in the air, foam on the surface, bubbles below it (the three
// classes of Ihmsen, Akinci, Akinci & Teschner 2012, "Unified spray, foam and air bubbles for particle-based fluids"). They do not act on the
// water or on each other. Of the drops that fall into the water a share becomes foam, which spreads and fades; a bubble bursts at the surface.
// Pure: no renderer.

import { kBoatsMax } from "../frames/bodies";

export const kinds = { spray: 0, foam: 1, bubble: 2, puff: 3 } as const;
/** Kind of a hull among the points that are drawn (whitewater_pass.ts). */
export const kHullPoint = 4;
export type Kind = (typeof kinds)[keyof typeof kinds];

/** What the particles move through. */
export interface Medium {
  /** Elevation of the surface; undefined outside the water. */
  elevationAtM(xM: number, zM: number): number | undefined;
  gravityMps2: number;
  windMps: { x: number; z: number };
}

/** A particle that begins. Positions in m, velocities in m/s. */
export interface Birth {
  kind: Kind;
  xM: number;
  yM: number;
  zM: number;
  vxMps: number;
  vyMps: number;
  vzMps: number;
  radiusM: number;
  lifeS: number;
}

/** Floats of one particle for the GPU: position (m), kind + share of its life that has passed, velocity (m/s), radius (m). */
export const kFloatsPerParticle = 8;

/** A drop loses speed against the air at this rate (1/s) per m/s, scaled to a drop of 1 cm: drag grows as the drop becomes smaller. */
const kDragPerM = 0.05;
const kDragRadiusM = 0.01;
/** Foam takes over the water's motion in about this time, and drifts with this share of the wind. */
const kFoamRelaxS = 0.6;
const kFoamWindShare = 0.02;
/** Bubbles of a few millimetres rise at about this speed. */
const kBubbleRiseMps = 0.28;
/** Life of the foam that a drop leaves, times 0.5 to 1.5. */
const kFoamLifeS = 2.2;
/** This share of the drops leaves a patch of foam where it falls, so many times as wide, up to a radius (m): each one would be a crumb by itself. */
export const kLandedShare = 0.2;
const kLandedRadii = 10;
const kMostLandedM = 0.08;
/** Longest step: a drop that falls into the water at 10 m/s is found at most 0.3 m below it. */
export const kMaxStepS = 1 / 30;

const isInAir = (kind: number): boolean => kind === kinds.spray || kind === kinds.puff;

export class DiffuseParticles {
  /** kFloatsPerParticle of each particle, the first `count` of which are alive, and room for kBoatsMax more points: hulls (whitewater_pass.ts). */
  readonly values: Float32Array<ArrayBuffer>;
  count = 0;
  private readonly lives: Float32Array;
  private readonly ages: Float32Array;
  private readonly kindOf: Uint8Array;

  /** `random`: 0..1. */
  constructor(
    readonly capacityCount: number,
    private readonly random: () => number,
  ) {
    this.values = new Float32Array((capacityCount + kBoatsMax) * kFloatsPerParticle);
    this.lives = new Float32Array(capacityCount);
    this.ages = new Float32Array(capacityCount);
    this.kindOf = new Uint8Array(capacityCount);
  }

  /** Adds a particle. When all slots are taken the new one is left out: the oldest ones vanish soon by themselves. */
  add(birth: Birth): void {
    if (this.count >= this.capacityCount) return;
    const n = this.count++;
    const { values } = this;
    const at = n * kFloatsPerParticle;
    values[at] = birth.xM;
    values[at + 1] = birth.yM;
    values[at + 2] = birth.zM;
    values[at + 4] = birth.vxMps;
    values[at + 5] = birth.vyMps;
    values[at + 6] = birth.vzMps;
    values[at + 7] = birth.radiusM;
    this.lives[n] = birth.lifeS;
    this.ages[n] = 0;
    this.setKind(n, birth.kind);
  }

  clear(): void {
    this.count = 0;
  }

  /** Moves all particles by `stepS` <= kMaxStepS and removes those whose life is over or that left the water's square. */
  step(stepS: number, medium: Medium): void {
    for (let n = 0; n < this.count; ) {
      this.ages[n]! += stepS;
      if (this.ages[n]! < this.lives[n]! && this.move(n, stepS, medium)) {
        this.values[n * kFloatsPerParticle + 3] = this.kindOf[n]! + Math.min(this.ages[n]! / this.lives[n]!, 0.999);
        ++n;
      } else this.remove(n);
    }
  }

  /** Returns how many particles of a kind there are. */
  countOf(kind: Kind): number {
    let sum = 0;
    for (let n = 0; n < this.count; ++n) sum += Number(this.kindOf[n] === kind);
    return sum;
  }

  /** Returns false if the particle is gone. */
  private move(n: number, stepS: number, { elevationAtM, gravityMps2, windMps }: Medium): boolean {
    const { values } = this;
    const at = n * kFloatsPerParticle;
    const kind = this.kindOf[n]!;
    if (isInAir(kind)) {
      const [rx, ry, rz] = [values[at + 4]! - windMps.x, values[at + 5]!, values[at + 6]! - windMps.z];
      const perS = kDragPerM * Math.hypot(rx, ry, rz) * (kDragRadiusM / Math.max(values[at + 7]!, 1e-3));
      const kept = 1 / (1 + perS * stepS);
      values[at + 4] = windMps.x + rx * kept;
      values[at + 5] = ry * kept - gravityMps2 * stepS;
      values[at + 6] = windMps.z + rz * kept;
    } else {
      const kept = 1 / (1 + stepS / kFoamRelaxS);
      values[at + 4] = kFoamWindShare * windMps.x + (values[at + 4]! - kFoamWindShare * windMps.x) * kept;
      values[at + 6] = kFoamWindShare * windMps.z + (values[at + 6]! - kFoamWindShare * windMps.z) * kept;
      values[at + 5] = kind === kinds.bubble ? kBubbleRiseMps : 0;
    }
    for (let axis = 0; axis < 3; ++axis) values[at + axis]! += values[at + 4 + axis]! * stepS;
    const surfaceM = elevationAtM(values[at]!, values[at + 2]!);
    if (surfaceM === undefined) return false;
    if (kind === kinds.foam) values[at + 1] = surfaceM;
    else if (kind === kinds.bubble) return values[at + 1]! < surfaceM;
    else if (values[at + 1]! <= surfaceM && values[at + 5]! < 0) {
      if (this.random() >= kLandedShare) return false;
      this.becomeFoam(n, surfaceM);
    }
    return true;
  }

  private becomeFoam(n: number, surfaceM: number): void {
    const at = n * kFloatsPerParticle;
    this.values[at + 7] = Math.min(kLandedRadii * this.values[at + 7]!, kMostLandedM);
    this.values[at + 1] = surfaceM;
    this.values[at + 5] = 0;
    this.ages[n] = 0;
    this.lives[n] = kFoamLifeS * (0.5 + this.random());
    this.setKind(n, kinds.foam);
  }

  private setKind(n: number, kind: Kind): void {
    this.kindOf[n] = kind;
    this.values[n * kFloatsPerParticle + 3] = kind;
  }

  /** The last particle takes its place. */
  private remove(n: number): void {
    const last = --this.count;
    if (n === last) return;
    this.values.copyWithin(n * kFloatsPerParticle, last * kFloatsPerParticle, (last + 1) * kFloatsPerParticle);
    this.lives[n] = this.lives[last]!;
    this.ages[n] = this.ages[last]!;
    this.kindOf[n] = this.kindOf[last]!;
  }
}

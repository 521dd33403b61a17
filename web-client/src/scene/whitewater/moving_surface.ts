// The streamed surface between two frames, on the CPU: elevation, its rate of change and its slope. Pure.
import type { SurfaceFrame } from "../../net/messages";
import type { Between } from "../frames/frame_ring";

export interface SurfaceMotion {
  elevationM: number;
  /** Vertical speed of the surface. */
  riseMps: number;
  slopeX: number;
  slopeZ: number;
  /** 1/m, below 0 on crests. */
  curvaturePerM: number;
}

/** What white water has to know of the surface. */
export type Surface = Pick<MovingSurface, "cellM" | "elevationAtM" | "motionAt" | "visitAbove">;

/** Returns the surface of a room without a wave: particles have no level of their own, and boats swim at the resting one. */
export function restingSurface(sideM: number, widthM: number): Surface {
  const elevationAtM = (xM: number, zM: number): number | undefined => (Math.abs(xM) < sideM / 2 && Math.abs(zM) < widthM / 2 ? 0 : undefined);
  const motion = { elevationM: 0, riseMps: 0, slopeX: 0, slopeZ: 0, curvaturePerM: 0 };
  return { elevationAtM, cellM: 1, visitAbove: () => undefined, motionAt: (xM, zM) => (elevationAtM(xM, zM) === undefined ? undefined : motion) };
}

export class MovingSurface {
  private readonly sideM: number;
  private readonly widthM: number;
  private readonly from: Int16Array;
  private readonly to: Int16Array;
  private readonly resolutionCount: number;
  private readonly countZ: number;
  private readonly quantaM: readonly [number, number];
  private readonly mix: number;
  private readonly intervalS: number;
  // Overwritten by every call: thousands run per picture.
  private readonly motion: SurfaceMotion = { elevationM: 0, riseMps: 0, slopeX: 0, slopeZ: 0, curvaturePerM: 0 };

  constructor({ from, to, mix }: Readonly<Between<SurfaceFrame>>) {
    const earlier = from.resolutionCount === to.resolutionCount && from.countZ === to.countZ ? from : to;
    this.sideM = to.sideM;
    this.widthM = to.widthM;
    this.resolutionCount = to.resolutionCount;
    this.countZ = to.countZ;
    this.from = new Int16Array(earlier.buffer);
    this.to = new Int16Array(to.buffer);
    this.quantaM = [earlier.quantumM, to.quantumM];
    this.mix = mix;
    this.intervalS = to.timeS - earlier.timeS;
  }

  get cellM(): number {
    return this.sideM / this.resolutionCount;
  }

  /** Returns the elevation of the nearest sample; undefined outside the water. */
  elevationAtM(xM: number, zM: number): number | undefined {
    const at = this.sampleAt(xM, zM);
    if (at < 0) return undefined;
    return this.from[at]! * this.quantaM[0] * (1 - this.mix) + this.to[at]! * this.quantaM[1] * this.mix;
  }

  /** Returns how the surface moves at the nearest sample; undefined outside the water. The next call overwrites the result. */
  motionAt(xM: number, zM: number): Readonly<SurfaceMotion> | undefined {
    const at = this.sampleAt(xM, zM);
    return at < 0 ? undefined : this.motionOf(at);
  }

  /** Calls `visit` at each sample that is higher than `leastM`. */
  visitAbove(leastM: number, visit: (xM: number, zM: number, motion: Readonly<SurfaceMotion>) => void): void {
    const [n, cellM, cellZM] = [this.resolutionCount, this.cellM, this.widthM / this.countZ];
    const least = leastM / this.quantaM[1];
    for (let at = 0; at < this.to.length; ++at)
      if (this.to[at]! > least) visit(((at % n) + 0.5) * cellM - this.sideM / 2, (Math.floor(at / n) + 0.5) * cellZM - this.widthM / 2, this.motionOf(at));
  }

  private motionOf(at: number): Readonly<SurfaceMotion> {
    const n = this.resolutionCount;
    const { motion, to, from, quantaM } = this;
    const [i, k] = [at % n, Math.floor(at / n)];
    const [left, right] = [Math.max(i - 1, 0), Math.min(i + 1, n - 1)];
    const [back, front] = [Math.max(k - 1, 0), Math.min(k + 1, this.countZ - 1)];
    motion.elevationM = from[at]! * quantaM[0] * (1 - this.mix) + to[at]! * quantaM[1] * this.mix;
    motion.riseMps = this.intervalS > 0 ? (to[at]! * quantaM[1] - from[at]! * quantaM[0]) / this.intervalS : 0;
    motion.slopeX = ((to[k * n + right]! - to[k * n + left]!) * quantaM[1]) / (Math.max(right - left, 1) * this.cellM);
    motion.slopeZ = ((to[front * n + i]! - to[back * n + i]!) * quantaM[1]) / (Math.max(front - back, 1) * this.cellM);
    motion.curvaturePerM = ((to[k * n + right]! + to[k * n + left]! + to[front * n + i]! + to[back * n + i]! - 4 * to[at]!) * quantaM[1]) / this.cellM ** 2;
    return motion;
  }

  /** Returns the index of the sample nearest to a position, or -1. */
  private sampleAt(xM: number, zM: number): number {
    const n = this.resolutionCount;
    const i = Math.floor((xM / this.sideM + 0.5) * n);
    const k = Math.floor((zM / this.widthM + 0.5) * this.countZ);
    return i >= 0 && i < n && k >= 0 && k < this.countZ ? k * n + i : -1;
  }
}

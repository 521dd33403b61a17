// Elevations of the frame that is heard, without an object per question.
import type { SurfaceFrame } from "../net/messages";
import { clamp } from "../scene/maths/interpolate";

export class Heights {
  private frame: SurfaceFrame | undefined;
  private samples = new Int16Array(0);

  take(frame: SurfaceFrame): void {
    this.frame = frame;
    this.samples = new Int16Array(frame.buffer);
  }

  /** Returns the bilinear elevation, clamped to the water's edge; 0 before the first frame, and once its buffer was given back. */
  readonly elevationAtM = (xM: number, zM: number): number => {
    const { frame, samples } = this;
    if (!frame || samples.length === 0) return 0;
    const { sideM, widthM, resolutionCount: countX, countZ, quantumM } = frame;
    const u = clamp((xM / sideM + 0.5) * countX - 0.5, 0, countX - 1);
    const v = clamp((zM / widthM + 0.5) * countZ - 0.5, 0, countZ - 1);
    const i = Math.min(Math.floor(u), Math.max(countX - 2, 0));
    const k = Math.min(Math.floor(v), Math.max(countZ - 2, 0));
    const at = i + k * countX;
    const right = countX > 1 ? 1 : 0;
    const down = countZ > 1 ? countX : 0;
    const low = u - i;
    const high = v - k;
    const near = samples[at]! * (1 - low) + samples[at + right]! * low;
    const far = samples[at + down]! * (1 - low) + samples[at + down + right]! * low;
    return quantumM * (near * (1 - high) + far * high);
  };

  /** Returns whether a position is in the water below its surface. */
  isUnder(xM: number, yM: number, zM: number): boolean {
    const { frame } = this;
    return frame !== undefined && Math.abs(xM) <= frame.sideM / 2 && Math.abs(zM) <= frame.widthM / 2 && yM < this.elevationAtM(xM, zM);
  }
}

// Elevations on the CPU, from a frame's int16 samples: for clicks and for minimum and maximum, not for drawing.
import type { SurfaceFrame } from "../../net/messages";

/** Returns the bilinear elevation in metres at (x, z), clamped to the water's edge. */
export function elevationAtM(frame: SurfaceFrame, xM: number, zM: number): number {
  const [nx, nz] = [frame.resolutionCount, frame.countZ];
  const samples = new Int16Array(frame.buffer);
  const u = Math.min(Math.max((xM / frame.sideM + 0.5) * nx - 0.5, 0), nx - 1);
  const v = Math.min(Math.max((zM / frame.widthM + 0.5) * nz - 0.5, 0), nz - 1);
  const i = Math.max(Math.min(Math.floor(u), nx - 2), 0);
  const k = Math.max(Math.min(Math.floor(v), nz - 2), 0);
  const fu = u - i;
  const fv = v - k;
  const at = (di: number, dk: number): number => samples[Math.min(k + dk, nz - 1) * nx + Math.min(i + di, nx - 1)]!;
  const low = at(0, 0) * (1 - fu) + at(1, 0) * fu;
  const high = at(0, 1) * (1 - fu) + at(1, 1) * fu;
  return (low * (1 - fv) + high * fv) * frame.quantumM;
}

/** Returns the lowest and highest elevation of the frame. */
export function elevationRangeM(frame: SurfaceFrame): { minM: number; maxM: number } {
  let min = 32767;
  let max = -32768;
  for (const sample of new Int16Array(frame.buffer)) {
    if (sample < min) min = sample;
    if (sample > max) max = sample;
  }
  return { minM: min * frame.quantumM, maxM: max * frame.quantumM };
}

// Elevations on the CPU, from a frame's int16 samples: for clicks and for minimum and maximum, not for drawing.
import type { SurfaceFrame } from "../../net/messages";
import { bilinear } from "../../../client/codec/bilinear";

/** Returns the bilinear elevation in metres at (x, z), clamped to the water's edge. */
export function elevationAtM(frame: SurfaceFrame, xM: number, zM: number): number {
  const { sideM, widthM, resolutionCount, countZ, quantumM } = frame;
  const samples = new Int16Array(frame.buffer);
  return quantumM * bilinear({ lengthXM: sideM, lengthZM: widthM, countX: resolutionCount, countZ }, xM, zM, (at) => samples[at]!);
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

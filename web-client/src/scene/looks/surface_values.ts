// Values of the water's surface at a position, from the samples of the frames: the same that look_value.frag and look_surface.frag draw,
// without the rounding of textures. Pure.
import type { FoamFrame } from "../../net/messages";
import type { Between } from "../frames/frame_ring";
import type { PlaneCounts } from "../frames/frame_textures";
import { elevationRangeM } from "../frames/height_field";
import { depthAtM, type Bed } from "../landscape/terrain";
import { bilinear } from "../../../client/codec/bilinear";
import type { ShownSurfaces } from "../water/field_pass";

/** A rectangle of samples, and what is beyond its edges: the opposite edge, or the edge's own samples again. */
export interface Rectangle {
  sideM: number;
  widthM: number;
  periodicX: boolean;
  periodicZ: boolean;
}

function samplesOf({ sideM, widthM, periodicX, periodicZ }: Rectangle, { resolutionCount, countZ }: PlaneCounts): Parameters<typeof bilinear>[0] {
  return { lengthXM: sideM, lengthZM: widthM, countX: resolutionCount, countZ, periodicX, periodicZ };
}

/** The surface of one picture, for evaluation at many positions. Valid until the next frame arrives. */
export class ShownSurface {
  private readonly counts: PlaneCounts;
  private readonly planes: readonly Int16Array[];

  constructor(
    private readonly rectangle: Rectangle,
    private readonly shown: ShownSurfaces,
  ) {
    this.counts = shown.frames[2]!;
    this.planes = shown.frames.map(({ buffer }) => new Int16Array(buffer));
  }

  /** Distance between samples. */
  get cellM(): number {
    return this.rectangle.sideM / this.counts.resolutionCount;
  }

  /** The smallest difference of two elevations, in metres. */
  get quantumM(): number {
    return this.shown.frames[2]!.quantumM;
  }

  /** The smallest difference of two rates, in m/s: a quantum over the interval of the frames. 0 if rates are not known. */
  get rateQuantumMps(): number {
    return Math.max(...this.shown.ratesPerS.map(Math.abs)) * this.quantumM;
  }

  elevationM(xM: number, zM: number): number {
    return this.weighted(this.shown.weights, xM, zM);
  }

  /** Returns the vertical velocity of the surface: the derivative by time of elevationM(). */
  rateMps(xM: number, zM: number): number {
    return this.weighted(this.shown.ratesPerS, xM, zM);
  }

  /** Returns bounds of elevationM(). */
  boundsM(): { minM: number; maxM: number } {
    let minM = 0;
    let maxM = 0;
    this.shown.frames.forEach((frame, i) => {
      const weight = this.shown.weights[i]!;
      if (weight === 0) return;
      const range = elevationRangeM(frame);
      minM += weight * (weight > 0 ? range.minM : range.maxM);
      maxM += weight * (weight > 0 ? range.maxM : range.minM);
    });
    return { minM, maxM };
  }

  private weighted(weights: readonly number[], xM: number, zM: number): number {
    const { counts, planes } = this;
    const [a, b, c, d] = this.shown.frames.map(({ quantumM }, i) => weights[i]! * quantumM) as [number, number, number, number];
    return bilinear(samplesOf(this.rectangle, counts), xM, zM, (at) => a * planes[0]![at]! + b * planes[1]![at]! + c * planes[2]![at]! + d * planes[3]![at]!);
  }
}

/**
 * Returns the breaking criterion: the rate of rise, as the mean of four positions half a sample away, which at a sample has the weights
 * (1 2 1)^2 / 16 of the server's mean over 3 x 3 (shaders/wave/surface_rate.glsl), over sqrt(g d) with the still depth d.
 */
export function breakingCriterion(surface: ShownSurface, bed: Bed, gravityMps2: number, xM: number, zM: number): number {
  const half = surface.cellM / 2;
  const rateMps = (surface.rateMps(xM - half, zM - half) + surface.rateMps(xM + half, zM - half) + surface.rateMps(xM - half, zM + half) + surface.rateMps(xM + half, zM + half)) / 4;
  return rateMps / Math.sqrt(gravityMps2 * Math.max(depthAtM(bed, xM, zM), kLeastDepths * bed.depthM));
}

/** Where the still depth is below this share of the scene's depth, the server lets nothing break (shaders/wave/breaking.comp). */
export const kLeastDepths = 0.02;

/** Returns the streamed foam between two frames, 0 none to 255 white. */
export function foamAt(rectangle: Rectangle, { from, to, mix }: Readonly<Between<FoamFrame>>, xM: number, zM: number): number {
  const at = (frame: FoamFrame): number => {
    const bytes = new Uint8Array(frame.buffer);
    return bilinear(samplesOf(rectangle, frame), xM, zM, (at) => bytes[at]!);
  };
  const first = from.resolutionCount === to.resolutionCount && from.countZ === to.countZ ? from : to;
  return first === to || mix === 0 ? at(first) : at(first) * (1 - mix) + at(to) * mix;
}

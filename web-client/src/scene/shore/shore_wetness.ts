// How wet the ground is and how much foam the swash leaves, per sample of the surface's frames. Kept on the page: real depth = elevation -
// ground says where water stands; the rest follows from when it stood there last. Pure.
import type { FoamFrame, SurfaceFrame } from "../../net/messages";
import type { PlaneCounts } from "../frames/frame_textures";
import { clamp, ramp } from "../maths/interpolate";
import type { ShoreCells } from "./shore_ground";

/** Thinner water counts as none: three steps of a frame with the usual quantum, so that rounding does not wet dry ground. */
export const kFilmM = 0.003;
/** Ground is dry again this long after water left it. */
export const kDryingS = 45;
/** Foam fades by a factor of e within this time: on water, and as lace on the ground. */
const kFoamOnWaterS = 1.6;
const kFoamOnGroundS = 3.5;
/** Water that came to a position within this time belongs to the front. */
const kFrontS = 0.5;
/** A front is white by the speed at which it floods the ground: none below the first, all above the second. */
const kFillMps = [0.03, 0.14] as const;
/** Streamed foam on water shallower than this is left on the ground. */
const kThinM = 0.06;
/** Frames further apart than this say nothing about a front. */
const kFrontFramesS = 0.3;
/** Deeper ground than this share of the depth never falls dry. */
const kAlwaysWetDepths = 0.6;

/** Returns the wetness (1 to 0) of ground from which water went away `sinceS` ago. */
export function wetnessAfter(sinceS: number): number {
  return 1 - ramp(0, kDryingS, sinceS);
}

/** Returns the foam (0 to 1) of a front that has flooded a point with `depthM` of water within `sinceS`. */
export function frontFoam(depthM: number, sinceS: number): number {
  if (sinceS > kFrontS || depthM < 2 * kFilmM) return 0;
  return 0.95 * ramp(kFillMps[0], kFillMps[1], (depthM - kFilmM) / sinceS);
}

export class ShoreWetness {
  /** Wetness and foam of each sample, 0 to 255. */
  texels = new Uint8Array(2);
  counts: PlaneCounts = { resolutionCount: 1, countZ: 1 };
  private cells: ShoreCells | undefined;
  private timeS: number | undefined;
  /** Samples whose ground may fall dry. */
  private shore: Int32Array = new Int32Array(0);
  private foam = new Float32Array(1);
  /** When water stood on the sample last, and since when it does: NaN on dry ground. */
  private lastWetS = new Float64Array(1);
  private wetSinceS = new Float64Array(1);

  /** Forgets all, as for other water. */
  clear(): void {
    this.cells = undefined;
    this.timeS = undefined;
  }

  /** Follows the surface to the time of `frame`. `foam`: streamed at about that time. The first frame, and any that is earlier than the one before, tells only where water stands. */
  advance(frame: SurfaceFrame, foam: FoamFrame | undefined, cells: ShoreCells): void {
    if (cells !== this.cells) this.resize(cells);
    const { timeS, quantumM } = frame;
    const isFollowing = this.timeS !== undefined && timeS >= this.timeS;
    const stepS = isFollowing ? timeS - this.timeS! : 0;
    const showsFronts = stepS > 0 && stepS < kFrontFramesS;
    const samples = new Int16Array(frame.buffer);
    const foamAt = foam && foamSampler(foam, cells);
    const onWater = Math.exp(-stepS / kFoamOnWaterS);
    const onGround = Math.exp(-stepS / kFoamOnGroundS);
    for (const at of this.shore) {
      const depthM = samples[at]! * quantumM - cells.groundM[at]!;
      const isWet = depthM > kFilmM;
      if (!isFollowing) this.begin(at, isWet, timeS);
      let white = this.foam[at]! * (isWet ? onWater : onGround);
      if (isWet) {
        // Water that was not here at the last frame came at some time after it.
        if (Number.isNaN(this.wetSinceS[at]!)) this.wetSinceS[at] = timeS - stepS;
        this.lastWetS[at] = timeS;
        if (showsFronts) white = Math.max(white, frontFoam(depthM, timeS - this.wetSinceS[at]!));
        if (foamAt && depthM < kThinM) white = Math.max(white, foamAt(at));
      } else this.wetSinceS[at] = NaN;
      this.foam[at] = white;
      this.texels[2 * at] = Math.round(255 * wetnessAfter(timeS - this.lastWetS[at]!));
      this.texels[2 * at + 1] = Math.round(255 * white);
    }
    this.timeS = timeS;
  }

  /** Returns wetness and foam (0 to 1) of the sample at a position; undefined before the first frame. */
  at(shareX: number, shareZ: number): { wetness: number; foam: number } | undefined {
    if (this.timeS === undefined) return undefined;
    const { resolutionCount, countZ } = this.counts;
    const index = (share: number, count: number): number => clamp(Math.floor(share * count), 0, count - 1);
    const at = index(shareX, resolutionCount) + resolutionCount * index(shareZ, countZ);
    return { wetness: this.texels[2 * at]! / 255, foam: this.texels[2 * at + 1]! / 255 };
  }

  private begin(at: number, isWet: boolean, timeS: number): void {
    this.foam[at] = 0;
    this.lastWetS[at] = -Infinity;
    // Long ago, so that standing water is not a front.
    this.wetSinceS[at] = isWet ? timeS - 2 * kFrontS : NaN;
  }

  /** Takes another ground. What is known of the one before is kept, also at another level of detail. */
  private resize(cells: ShoreCells): void {
    const { resolutionCount, countZ } = cells;
    const count = resolutionCount * countZ;
    const before = { counts: this.counts, foam: this.foam, lastWetS: this.lastWetS, wetSinceS: this.wetSinceS };
    this.cells = cells;
    this.counts = { resolutionCount, countZ };
    this.texels = new Uint8Array(2 * count);
    this.foam = new Float32Array(count);
    this.lastWetS = new Float64Array(count).fill(-Infinity);
    this.wetSinceS = new Float64Array(count).fill(NaN);
    const deepestM = -kAlwaysWetDepths * cells.bedM.reduce((deepest, bedM) => Math.max(deepest, -bedM), 0);
    const shore: number[] = [];
    for (let at = 0; at < count; ++at) {
      if (cells.groundM[at]! > deepestM) shore.push(at);
      else this.texels[2 * at] = 255;
      if (this.timeS === undefined) continue;
      const column = Math.floor((((at % resolutionCount) + 0.5) * before.counts.resolutionCount) / resolutionCount);
      const row = Math.floor(((Math.floor(at / resolutionCount) + 0.5) * before.counts.countZ) / countZ);
      const from = column + before.counts.resolutionCount * row;
      this.foam[at] = before.foam[from]!;
      this.lastWetS[at] = before.lastWetS[from]!;
      this.wetSinceS[at] = before.wetSinceS[from]!;
    }
    this.shore = Int32Array.from(shore);
  }
}

/** Returns the streamed foam (0 to 1) by the index of a sample of the cells. */
function foamSampler(foam: FoamFrame, { resolutionCount, countZ }: PlaneCounts): (at: number) => number {
  const bytes = new Uint8Array(foam.buffer);
  if (foam.resolutionCount === resolutionCount && foam.countZ === countZ) return (at) => bytes[at]! / 255;
  const [perX, perZ] = [foam.resolutionCount / resolutionCount, foam.countZ / countZ];
  return (at) => bytes[Math.floor(((at % resolutionCount) + 0.5) * perX) + foam.resolutionCount * Math.floor((Math.floor(at / resolutionCount) + 0.5) * perZ)]! / 255;
}

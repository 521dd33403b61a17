// What the moving surface says: splashes where it is accelerated more than a wave can be, and lapping where it moves at an edge. It looks at
// a grid of at most kPointsAcross points along each axis. Pure; nothing is allocated per frame but a view of its samples.
import type { SurfaceFrame } from "../net/messages";
import { AreaTiles } from "./area_tiles";
import type { SoundEvents } from "./sound_events";

const kPointsAcross = 64;
const kPointsMax = kPointsAcross * kPointsAcross;
/** Events are looked for in so many tiles along an axis. */
const kTilesAcross = 8;
const kTileCount = kTilesAcross * kTilesAcross;
/** The crest of a wave is accelerated by at most half of gravity before it breaks (Phillips 1958); what is accelerated more was hit. */
const kSteepestG = 0.5;
/** Rounding moves an elevation by half a step; three samples make an acceleration. */
const kRoundingSteps = 3;
/** Acceleration above that, in gravities, beyond which water is not louder. */
const kMostG = 4;
/** An event is this much stronger than the motion before it in its tile, which is forgotten within kForgetS. */
const kOnset = 2;
const kForgetS = 0.25;
/** Frames further apart say nothing about accelerations. */
const kGapS = 0.25;
/** Area of lapping water per area and m/s of vertical speed above the least. */
const kLapPerMps = 0.6;
const kLeastLapMps = 0.02;
/** Share of what is accelerated steadily that is heard as breaking. */
const kSteadyShare = 0.5;

export class SurfaceWatch {
  /** Water that laps at edges. */
  readonly lapping = new AreaTiles();
  private countX = 0;
  private countZ = 0;
  private resolutionCount = 0;
  private rowsCount = 0;
  private timeS = 0;
  private stepS = 0;
  private seenCount = 0;
  private readonly heightM = new Float32Array(kPointsMax);
  private readonly speedMps = new Float32Array(kPointsMax);
  private readonly isEdge = new Uint8Array(kPointsMax);
  private readonly energyM2 = new Float32Array(kTileCount);
  private readonly areaM2 = new Float32Array(kTileCount);
  private readonly sumX = new Float32Array(kTileCount);
  private readonly sumZ = new Float32Array(kTileCount);
  private readonly beforeM2 = new Float32Array(kTileCount);

  /** `isEdgeAt`: the water laps at something at this position; `cellM`: distance of the points. It is asked once per point and resolution. */
  constructor(private readonly isEdgeAt: (xM: number, zM: number, cellM: number) => boolean) {}

  /** Adds splashes to `events`, and to `breaking` the water that is thrown about all the time. */
  take(frame: SurfaceFrame, gravityMps2: number, events: SoundEvents, breaking: AreaTiles): void {
    const stepS = frame.timeS - this.timeS;
    if (frame.resolutionCount !== this.resolutionCount || frame.countZ !== this.rowsCount) this.resize(frame);
    else if (!(stepS > 0 && stepS < kGapS)) this.seenCount = 0;
    const { countX, countZ, heightM, speedMps, isEdge, energyM2, areaM2, sumX, sumZ, lapping } = this;
    const { sideM, widthM, quantumM, resolutionCount } = frame;
    const samples = new Int16Array(frame.buffer);
    const cellX = sideM / countX;
    const cellZ = widthM / countZ;
    const cellM2 = cellX * cellZ;
    const meanStepS = (stepS + this.stepS) / 2;
    const leastMps2 = Math.max(kSteepestG * gravityMps2, (kRoundingSteps * quantumM) / (stepS * stepS));
    energyM2.fill(0);
    areaM2.fill(0);
    sumX.fill(0);
    sumZ.fill(0);
    for (let k = 0, point = 0; k < countZ; ++k) {
      const row = Math.floor(((k + 0.5) * this.rowsCount) / countZ) * resolutionCount;
      const tileRow = Math.floor((k * kTilesAcross) / countZ) * kTilesAcross;
      const zM = (k + 0.5) * cellZ - widthM / 2;
      for (let i = 0; i < countX; ++i, ++point) {
        const nowM = samples[row + Math.floor(((i + 0.5) * resolutionCount) / countX)]! * quantumM;
        const nowMps = (nowM - heightM[point]!) / stepS;
        const beforeMps = speedMps[point]!;
        heightM[point] = nowM;
        speedMps[point] = nowMps;
        if (this.seenCount < 1) continue;
        if (isEdge[point] && Math.abs(nowMps) > kLeastLapMps) lapping.add((i + 0.5) * cellX - sideM / 2, zM, sideM, widthM, kLapPerMps * cellM2 * (Math.abs(nowMps) - kLeastLapMps));
        if (this.seenCount < 2) continue;
        const above = Math.abs(nowMps - beforeMps) / meanStepS - leastMps2;
        if (above <= 0) continue;
        const tile = tileRow + Math.floor((i * kTilesAcross) / countX);
        const thrownM2 = cellM2 * Math.min(above / gravityMps2, kMostG);
        energyM2[tile]! += thrownM2;
        areaM2[tile]! += cellM2;
        sumX[tile]! += thrownM2 * ((i + 0.5) * cellX - sideM / 2);
        sumZ[tile]! += thrownM2 * zM;
      }
    }
    if (this.seenCount >= 2) this.tell(frame, stepS, events, breaking);
    lapping.settle(this.seenCount >= 1 ? stepS : kGapS);
    this.timeS = frame.timeS;
    this.stepS = stepS;
    ++this.seenCount;
  }

  private tell({ sideM, widthM }: SurfaceFrame, stepS: number, events: SoundEvents, breaking: AreaTiles): void {
    const { energyM2, areaM2, sumX, sumZ, beforeM2 } = this;
    const kept = Math.exp(-stepS / kForgetS);
    for (let tile = 0; tile < kTileCount; ++tile) {
      const energy = energyM2[tile]!;
      const before = beforeM2[tile]! * kept;
      beforeM2[tile] = Math.max(energy, before);
      if (energy <= 0) continue;
      const xM = sumX[tile]! / energy;
      const zM = sumZ[tile]! / energy;
      if (energy > kOnset * before) events.add("splash", xM, 0, zM, energy, Math.sqrt(areaM2[tile]! / Math.PI));
      else breaking.add(xM, zM, sideM, widthM, kSteadyShare * energy);
    }
  }

  private resize({ resolutionCount, countZ, sideM, widthM }: SurfaceFrame): void {
    this.resolutionCount = resolutionCount;
    this.rowsCount = countZ;
    this.countX = Math.min(resolutionCount, kPointsAcross);
    this.countZ = Math.min(countZ, kPointsAcross);
    this.seenCount = 0;
    this.beforeM2.fill(0);
    this.lapping.clear();
    const cellX = sideM / this.countX;
    const cellZ = widthM / this.countZ;
    for (let point = 0; point < this.countX * this.countZ; ++point) {
      const xM = ((point % this.countX) + 0.5) * cellX - sideM / 2;
      const zM = (Math.floor(point / this.countX) + 0.5) * cellZ - widthM / 2;
      this.isEdge[point] = Number(this.isEdgeAt(xM, zM, Math.max(cellX, cellZ)));
    }
  }
}

// Boats → where the water stands against their hulls. In the simulation a hull presses its weight on the water, which gives way under all of
// it; the surface drawn rises again to the line at which the hull floats, and to a wave at its bow.
import { Vector4, type IUniform } from "three";

import type { GreetingInfo } from "../../../client/codec/greeting";
import type { BodyPose } from "../../../client/codec/bodies";
import type { Pass, Picture } from "../drawing/pass";
import { kBoatsMax, mixBodies } from "../frames/bodies";
import type { StreamedFrames } from "../frames/streamed_frames";

/** Vectors of each hull; this number and that of the boats are in elevation.frag, too. */
const kVectors = 3;
/** A hull presses on at least this many cells to each side of its centre (shaders/bodies/boat.glsl). */
const kCellsLeast = 1.5;
/** Its pressure in the middle over that of the same water in a box. */
const kPeak = 1 / 0.9064 ** 2;
/** Height of the bow wave: this share of that at which water of the hull's speed comes to rest, U^2 / 2g, and at most so many draughts. */
const kBowShare = 0.18;
const kMostBowDraughts = 1.2;
/** A hull without draught, or water without weight, would divide by 0. */
const kLeastDraughtM = 1e-3;
const kLeastGravityMps2 = 0.1;

export class WaterlinesPass implements Pass {
  readonly name = "waterlines";
  readonly reads = ["frames"] as const;
  readonly writes = ["waterlines"] as const;
  /**
   * Of each hull: position x and z [m], heading as cosine and sine; half length and half beam over which it presses [m], its pressure as a
   * height of water [m], draught [m]; height of the waterline [m], its slope ahead and to starboard, height of the bow wave [m].
   */
  readonly hulls: IUniform<Vector4[]> = { value: Array.from({ length: kVectors * kBoatsMax }, () => new Vector4()) };
  readonly count: IUniform<number> = { value: 0 };
  private readonly poses: BodyPose[] = [];

  /** `greeting`: its boats change. */
  constructor(
    private readonly greeting: Pick<GreetingInfo, "boats" | "gravityMps2">,
    private readonly frames: StreamedFrames,
    private readonly cellM: number,
  ) {}

  draw({ shownS }: Picture): void {
    this.count.value = 0;
    const bodies = shownS === undefined ? undefined : this.frames.bodies.around(shownS);
    if (!bodies) return;
    const posesCount = mixBodies(bodies.from, bodies.to, bodies.mix, this.poses);
    for (let i = 0; i < posesCount && this.count.value < kBoatsMax; ++i) this.add(this.poses[i]!);
  }

  dispose(): void {}

  private add({ boatId, xM, yM, zM, headingRad, pitchRad, rollRad, speedMps }: BodyPose): void {
    const boat = this.greeting.boats.find((detail) => detail.boatId === boatId);
    if (!boat) return;
    const { lengthM, beamM, heightM } = boat;
    const draughtM = Math.max(boat.draughtM, kLeastDraughtM);
    const at = kVectors * this.count.value++;
    const halfLengthM = Math.max(lengthM / 2, kCellsLeast * this.cellM);
    const halfBeamM = Math.max(beamM / 2, kCellsLeast * this.cellM);
    this.hulls.value[at]!.set(xM, zM, Math.cos(headingRad), Math.sin(headingRad));
    this.hulls.value[at + 1]!.set(halfLengthM, halfBeamM, (kPeak * draughtM * lengthM * beamM) / (4 * halfLengthM * halfBeamM), draughtM);
    const headM = speedMps ** 2 / (2 * Math.max(this.greeting.gravityMps2, kLeastGravityMps2));
    const bowM = Math.min(kBowShare * headM, kMostBowDraughts * draughtM);
    this.hulls.value[at + 2]!.set(yM - heightM / 2 + draughtM, Math.tan(pitchRad), -Math.tan(rollRad), bowM);
  }
}

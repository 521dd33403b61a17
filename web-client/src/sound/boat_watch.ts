// What boats do to the water: the bow slaps on it, the bow wave washes, hulls knock. Pure.
import type { BoatDetail } from "../../client/codec/greeting";
import type { BodyPose } from "../../client/codec/bodies";
import type { BodiesState } from "../scene/frames/bodies";
import { ramp } from "../scene/maths/interpolate";
import type { SoundEvents } from "./sound_events";

/** A bow slams if it meets the surface faster than this times sqrt(g L) (Ochi 1964). */
const kSlamFroude = 0.093;
/** Then it is silent for this long. */
const kRestS = 0.25;
/** Share of the bottom that hits at the least speed, and most times as much. */
const kSlapShare = 0.12;
const kMostTimes = 4;
/** A hull that is slowed by more than this share of gravity within a frame has hit something. */
const kKnockG = 0.6;
const kKnockShare = 0.15;
/** Froude numbers from which a bow wave is heard, and at which it is loudest. */
const kWashFroude = [0.12, 0.6] as const;
const kWashShare = 0.5;
const kWashesMax = 8;
/** Frames further apart say nothing; a longer way is a jump to the other side of the water. */
const kGapS = 0.3;
const kJumpM = 3;

interface Wash {
  boatId: number;
  xM: number;
  yM: number;
  zM: number;
  areaM2: number;
}

interface Track {
  timeS: number;
  xM: number;
  zM: number;
  speedMps: number;
  /** Of the bow over the surface. */
  gapM: number;
  closingMps: number;
  slappedS: number;
}

export class BoatWatch {
  /** Bow waves of the newest frame; the first `washCount` count. */
  readonly washes: readonly Wash[] = Array.from({ length: kWashesMax }, () => ({ boatId: 0, xM: 0, yM: 0, zM: 0, areaM2: 0 }));
  washCount = 0;
  private readonly tracks = new Map<number, Track>();

  take({ timeS, bodies }: BodiesState, hulls: readonly BoatDetail[], gravityMps2: number, elevationAtM: (xM: number, zM: number) => number, events: SoundEvents): void {
    this.washCount = 0;
    for (const pose of bodies) {
      const hull = hullOf(hulls, pose.boatId);
      if (hull) this.follow(pose, hull, timeS, gravityMps2, elevationAtM, events);
    }
    if (this.tracks.size > bodies.length) for (const [boatId, track] of this.tracks) if (track.timeS !== timeS) this.tracks.delete(boatId);
  }

  private follow(pose: BodyPose, { lengthM, beamM }: BoatDetail, timeS: number, gravityMps2: number, elevationAtM: (xM: number, zM: number) => number, events: SoundEvents): void {
    const { boatId, xM, yM, zM, headingRad, pitchRad, speedMps } = pose;
    const bowX = xM + Math.cos(headingRad) * 0.45 * lengthM;
    const bowZ = zM + Math.sin(headingRad) * 0.45 * lengthM;
    const gapM = yM + Math.sin(pitchRad) * 0.45 * lengthM - elevationAtM(bowX, bowZ);
    const rootGL = Math.sqrt(gravityMps2 * lengthM);
    const wash = ramp(kWashFroude[0], kWashFroude[1], Math.abs(speedMps) / rootGL);
    if (wash > 0 && this.washCount < kWashesMax) {
      const out = this.washes[this.washCount++]!;
      out.boatId = boatId;
      out.xM = bowX;
      out.yM = yM;
      out.zM = bowZ;
      out.areaM2 = kWashShare * wash * wash * lengthM * beamM;
    }
    let track = this.tracks.get(boatId);
    if (!track) this.tracks.set(boatId, (track = { timeS, xM, zM, speedMps, gapM, closingMps: 0, slappedS: -Infinity }));
    const stepS = timeS - track.timeS;
    const jumps = Math.abs(xM - track.xM) + Math.abs(zM - track.zM) > kJumpM;
    const isNext = stepS > 0 && stepS < kGapS && !jumps;
    const closingMps = isNext ? (track.gapM - gapM) / stepS : 0;
    if (isNext) {
      const times = closingMps / (kSlamFroude * rootGL);
      if (times > 1 && closingMps > track.closingMps && timeS - track.slappedS > kRestS) {
        track.slappedS = timeS;
        events.add("slap", bowX, yM, bowZ, kSlapShare * lengthM * beamM * Math.min(times * times, kMostTimes), beamM / 2, boatId);
      }
      if (Math.abs(speedMps - track.speedMps) / stepS > kKnockG * gravityMps2) events.add("knock", bowX, yM, bowZ, kKnockShare * lengthM * beamM, beamM / 2, boatId);
    }
    // A reset begins anew.
    if (stepS < 0) track.slappedS = -Infinity;
    track.timeS = timeS;
    track.xM = xM;
    track.zM = zM;
    track.speedMps = speedMps;
    track.gapM = gapM;
    track.closingMps = closingMps;
  }
}

function hullOf(hulls: readonly BoatDetail[], boatId: number): BoatDetail | undefined {
  for (const hull of hulls) if (hull.boatId === boatId) return hull;
  return undefined;
}

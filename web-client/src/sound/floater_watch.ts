// Objects that fall into the water. Pure.
import type { FloatersState } from "../scene/frames/floaters";
import type { SoundEvents } from "./sound_events";

/** Slower ones make no sound. */
const kLeastFallMps = 0.4;
/** Water thrown up at a Froude number of 1, over the square of the size, and most times as much. */
const kThrownSizes2 = 0.4;
const kMostTimes = 4;
/** An object that was dropped in the water already. */
const kDroppedTimes = 0.5;
const kGapS = 0.3;

interface Track {
  timeS: number;
  /** Of its lower end over the surface. */
  gapM: number;
}

export class FloaterWatch {
  private readonly tracks = new Map<number, Track>();
  private isFollowing = false;

  take({ timeS, floaters }: FloatersState, gravityMps2: number, elevationAtM: (xM: number, zM: number) => number, events: SoundEvents): void {
    for (const { floaterId, xM, yM, zM, sizeM } of floaters) {
      const gapM = yM - sizeM / 2 - elevationAtM(xM, zM);
      const track = this.tracks.get(floaterId);
      if (!track) {
        this.tracks.set(floaterId, { timeS, gapM });
        if (this.isFollowing && gapM <= 0 && gapM > -sizeM) events.add("plunge", xM, yM, zM, kThrownSizes2 * kDroppedTimes * sizeM * sizeM, sizeM / 2);
        continue;
      }
      const stepS = timeS - track.timeS;
      const fallMps = stepS > 0 && stepS < kGapS ? (track.gapM - gapM) / stepS : 0;
      if (fallMps > kLeastFallMps && track.gapM > 0 && gapM <= 0) {
        const froude2 = (fallMps * fallMps) / (gravityMps2 * Math.max(sizeM, 0.01));
        events.add("plunge", xM, yM, zM, kThrownSizes2 * sizeM * sizeM * Math.min(froude2, kMostTimes), sizeM / 2);
      }
      track.timeS = timeS;
      track.gapM = gapM;
    }
    this.isFollowing = true;
    if (this.tracks.size > floaters.length) for (const [floaterId, track] of this.tracks) if (track.timeS !== timeS) this.tracks.delete(floaterId);
  }
}

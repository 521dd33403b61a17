// Which sounds get a voice: the loudest. Beds last (surf, rain), grains are short (a bubble, a slap). Pure.

/** Most sounds at a time, together 12. */
export const kBedCount = 5;
export const kGrainCount = 7;

/** A sound takes the voice of another only if it is this much louder. */
const kLouder = 1.5;
/** A voice fades this long before it changes its sound. */
export const kFadeS = 0.12;
/** Quieter sounds are not heard. */
const kSilent = 0.002;
const kOffersMax = 48;
const kNone = -1;

/** Voices for sounds that last. Each update offers all that sound now, and then settles. */
export class BedPlan {
  /** Number of the offer that a voice plays in this update, or -1: silence, also while it fades for another sound. */
  readonly offerOf = new Int32Array(kBedCount).fill(kNone);
  private readonly keyOf = new Int32Array(kBedCount).fill(kNone);
  private readonly levelOf = new Float64Array(kBedCount);
  private readonly readyS = new Float64Array(kBedCount);
  private readonly keys = new Int32Array(kOffersMax);
  private readonly levels = new Float64Array(kOffersMax);
  private readonly isTaken = new Uint8Array(kOffersMax);
  private count = 0;

  /** `key`: the same for the same sound in every update, not below 0. Returns the number of the offer, or -1 if it is not heard. */
  offer(key: number, level: number): number {
    if (!(level > kSilent) || this.count === kOffersMax) return kNone;
    this.keys[this.count] = key;
    this.levels[this.count] = level;
    return this.count++;
  }

  /** Gives the voices to the loudest offers. A voice keeps its sound unless another is much louder. */
  settle(nowS: number): void {
    const { offerOf, keyOf, levelOf, readyS, keys, levels, isTaken, count } = this;
    isTaken.fill(0);
    offerOf.fill(kNone);
    for (let voice = 0; voice < kBedCount; ++voice) {
      levelOf[voice] = 0;
      for (let n = 0; n < count; ++n)
        if (keys[n] === keyOf[voice]) {
          offerOf[voice] = n;
          levelOf[voice] = levels[n]!;
          isTaken[n] = 1;
        }
    }
    for (let change = 0; change < kBedCount; ++change) {
      let loudest = kNone;
      for (let n = 0; n < count; ++n) if (!isTaken[n] && (loudest === kNone || levels[n]! > levels[loudest]!)) loudest = n;
      let quietest = 0;
      for (let voice = 1; voice < kBedCount; ++voice) if (levelOf[voice]! < levelOf[quietest]!) quietest = voice;
      if (loudest === kNone || levels[loudest]! < kLouder * levelOf[quietest]!) break;
      if (offerOf[quietest] !== kNone) isTaken[offerOf[quietest]!] = 0;
      isTaken[loudest] = 1;
      offerOf[quietest] = loudest;
      keyOf[quietest] = keys[loudest]!;
      levelOf[quietest] = levels[loudest]!;
      readyS[quietest] = nowS + kFadeS;
    }
    for (let voice = 0; voice < kBedCount; ++voice) if (nowS < readyS[voice]!) offerOf[voice] = kNone;
    this.count = 0;
  }
}

/** Voices for short sounds, which decay by a factor of e within their own time. */
export class GrainPlan {
  private readonly level = new Float64Array(kGrainCount);
  private readonly startS = new Float64Array(kGrainCount);
  private readonly decayS = new Float64Array(kGrainCount).fill(1);

  /** Returns the voice for a sound that begins at `startS`, or -1 if all play louder ones. */
  take(level: number, startS: number, decayS: number): number {
    if (!(level > kSilent)) return kNone;
    let quietest = 0;
    for (let voice = 1; voice < kGrainCount; ++voice) if (this.leftAt(voice, startS) < this.leftAt(quietest, startS)) quietest = voice;
    const left = this.leftAt(quietest, startS);
    if (left > kSilent && level < kLouder * left) return kNone;
    this.level[quietest] = level;
    this.startS[quietest] = startS;
    this.decayS[quietest] = decayS;
    return quietest;
  }

  /** Returns how many voices sound. */
  soundingAt(nowS: number): number {
    let count = 0;
    for (let voice = 0; voice < kGrainCount; ++voice) if (this.leftAt(voice, nowS) > kSilent) ++count;
    return count;
  }

  private leftAt(voice: number, nowS: number): number {
    return this.level[voice]! * Math.exp(-Math.max(nowS - this.startS[voice]!, 0) / this.decayS[voice]!);
  }
}

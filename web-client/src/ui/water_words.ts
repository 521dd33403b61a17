// The state of the water in sentences for screen readers: what has changed, one sentence at a time and not more often than one bears. Pure.
import type { PictureSide } from "./side_names";
import { kTexts } from "./texts";

/** Time between two sentences. */
export const kSentenceEveryS = 10;
/** Waves are told of again when they are so many times as high, or as low. */
const kHeightTimes = 1.6;
/** Water is calm below this height of its waves, as a share of its shorter side. */
const kCalmSides = 0.003;
/** From this share on a storm is a storm, and a strong one. */
const kStormRatios = [0.05, 0.6] as const;
const kStorms = ["none", "some", "strong"] as const;

/** What there is to tell at a moment. */
export interface WaterSight {
  /** Undefined while all is well: the state of the connection in words. */
  trouble: string | undefined;
  isPaused: boolean;
  /** From the lowest trough to the highest crest; undefined without a wave. */
  heightM: number | undefined;
  sideM: number;
  /** Of the room, 0 to 1. */
  stormRatio: number;
  /** Who draws in the water now, and where; names are empty for oneself. */
  hands: readonly { name: string; side: PictureSide }[];
}

export class WaterWords {
  private saidAtS = -Infinity;
  private trouble: string | undefined;
  private isPaused = false;
  private storm: (typeof kStorms)[number] = "none";
  private heightM: number | undefined;
  private names: ReadonlySet<string> = new Set();

  /** Returns the sentence for this moment; undefined if nothing has changed, or the last one was just now. */
  take(sight: WaterSight, nowS: number): string | undefined {
    if (nowS - this.saidAtS < kSentenceEveryS) return undefined;
    const sentence = this.next(sight);
    if (sentence !== undefined) this.saidAtS = nowS;
    return sentence;
  }

  /** What matters most comes first; the rest has its turn later, if it is still so. */
  private next({ trouble, isPaused, heightM, sideM, stormRatio, hands }: WaterSight): string | undefined {
    if (trouble !== this.trouble) {
      this.trouble = trouble;
      return trouble === undefined ? kTexts.words.connected : kTexts.noConnection(trouble);
    }
    if (trouble !== undefined) return undefined;
    if (isPaused !== this.isPaused) {
      this.isPaused = isPaused;
      return isPaused ? kTexts.words.paused : kTexts.words.runs;
    }
    const storm = kStorms[kStormRatios.filter((least) => stormRatio >= least).length]!;
    if (storm !== this.storm) {
      this.storm = storm;
      return kTexts.words.storms[storm];
    }
    const newcomer = hands.find(({ name }) => !this.names.has(name));
    this.names = new Set(hands.map(({ name }) => name));
    if (newcomer) return newcomer.name === "" ? kTexts.words.own(newcomer.side) : kTexts.words.draws(newcomer.name, newcomer.side);
    return this.waves(heightM, sideM);
  }

  private waves(heightM: number | undefined, sideM: number): string | undefined {
    if (heightM === undefined) return undefined;
    const height = heightM < kCalmSides * sideM ? 0 : heightM;
    const { heightM: before } = this;
    if (before !== undefined && (before === 0 || height === 0 ? before === height : Math.max(height / before, before / height) < kHeightTimes)) return undefined;
    this.heightM = height;
    return height === 0 ? kTexts.words.calm : kTexts.words.waves(height);
  }
}

// The range of values that a colour map spans, and the ticks of its bar. Pure.

export interface ValueRange {
  low: number;
  high: number;
}

/** A range that follows the water narrows after this long with smaller values; it widens at once. */
export const kNarrowAfterS = 5;
/** It spans all but this share of the values that differ from rest. A crest is a small part of the water, and much higher than the rest. */
export const kBeyondShares = { surface: 0.1, particles: 0.01 } as const;
const kMostTicks = 6;

/** Returns the smallest of 1, 2, 5, 10, ... times a power of ten that is not below `value`. */
export function niceAbove(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value));
  const share = value / power;
  const slack = 1 + 1e-9;
  // Divided where the power is below 1, so that the result is the number nearest to the decimal one.
  const times = share <= slack ? 1 : share <= 2 * slack ? 2 : share <= 5 * slack ? 5 : 10;
  return power < 1 ? times / Math.round(1 / power) : times * power;
}

/** Returns three to seven ticks at round numbers inside the range. */
export function ticksOf({ low, high }: ValueRange): number[] {
  const step = niceAbove((high - low) / kMostTicks);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, i) => Number(((first + i) * step).toPrecision(12)));
}

/** Returns the magnitude that all but the share `beyond` of those above `least` stay below; 0 if none is above it. Sorts `magnitudes`. */
export function reachOf(magnitudes: Float64Array, least: number, beyond: number): number {
  magnitudes.sort();
  const restCount = magnitudes.findIndex((magnitude) => magnitude > least);
  if (restCount < 0) return 0;
  return magnitudes[restCount + Math.ceil((1 - beyond) * (magnitudes.length - restCount)) - 1]!;
}

/** A range in steps of 1, 2 and 5: from -limit or 0 to limit. */
export class RangeFollower {
  private limit = 0;
  private largest = 0;
  private smallerSinceS: number | undefined;

  constructor(private readonly isSigned: boolean) {}

  get range(): ValueRange {
    const high = this.limit > 0 ? this.limit : 1;
    return { low: this.isSigned ? -high : 0, high };
  }

  /** Takes the magnitude that the values reach now; `least`: the smallest useful limit, above 0. Returns true if the range changed. */
  note(reach: number, least: number, nowS: number): boolean {
    const wanted = niceAbove(Math.max(reach, least));
    const before = this.limit;
    if (wanted >= before) {
      this.limit = wanted;
      this.smallerSinceS = undefined;
    } else if (this.smallerSinceS === undefined) {
      this.smallerSinceS = nowS;
      this.largest = wanted;
    } else {
      this.largest = Math.max(this.largest, wanted);
      if (nowS - this.smallerSinceS >= kNarrowAfterS) {
        this.limit = this.largest;
        this.smallerSinceS = undefined;
      }
    }
    return this.limit !== before;
  }
}

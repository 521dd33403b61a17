// Reads what server/stream/codec/residual_coder wrote: residuals in groups of up to 64, by asymmetric numeral systems with
// the fixed table of each group's class, and raw bits beside them. proto/README.md describes the format. Bytes that are
// damaged give wrong numbers and an end that does not fit, nothing worse.

const kSlotBits = 12;
const kSlotCount = 1 << kSlotBits;
const kLaneCount = 4;
const kLow = 0x10000;
const kClassCount = 45;
const kFirstShiftedClass = 18;
const kRawResidualBits = 16;

/** 2^32 times the weight of 1 over that of 0, and the largest value in the table, of classes 1 to 17. */
const kNormals: [ratio: number, largest: number][] = [
  [33048663, 4], [47037629, 4], [67129970, 4], [96180043, 4], [138583811, 4], [201340740, 4], [296102537, 4], [443370733, 4],
  [681172609, 4], [1077842265, 4], [1704127699, 4], [2475875289, 4], [3169595364, 6], [3659567669, 8], [3955829142, 12],
  [4119551104, 16], [4205730481, 24],
];

/** Values -largest to largest (half-way: one more below), then the escape; frequencies sum up to kSlotCount. */
function frequenciesOf([ratio, largest]: [number, number], isHalfway: boolean): number[] {
  const one = 1n << 32n;
  const first = BigInt(ratio);
  const squared = (first * first) >> 32n;
  const weights = [one];
  for (let step = isHalfway ? squared : first; weights.length <= largest; step = (step * squared) >> 32n)
    weights.push((weights[weights.length - 1]! * step) >> 32n);
  const bySymbol = [...weights.slice(isHalfway ? 0 : 1).reverse(), ...weights];
  const sum = bySymbol.reduce((a, b) => a + b, 0n);
  const frequencies = bySymbol.map((weight) => Math.max(Number((weight * BigInt(2 * kSlotCount) + sum) / (2n * sum)), 1));
  frequencies.push(1);
  const used = frequencies.reduce((a, b) => a + b, 0);
  frequencies[largest + (isHalfway ? 1 : 0)]! += kSlotCount - used;
  return frequencies;
}

/** Of each slot: symbol | frequency << 8 | slot - start << 20. */
export function slotsOf(frequencies: readonly number[]): Int32Array {
  const slots = new Int32Array(kSlotCount);
  let start = 0;
  frequencies.forEach((frequency, symbol) => {
    for (let k = 0; k < frequency; ++k) slots[start + k] = symbol | (frequency << 8) | (k << 20);
    start += frequency;
  });
  return slots;
}

interface ClassCode {
  slots: Int32Array;
  shift: number;
  offset: number;
  escape: number;
}

function makeClassCodes(): ClassCode[] {
  const codes: ClassCode[] = [{ slots: new Int32Array(0), shift: 0, offset: 0, escape: 0 }];
  for (const normal of kNormals)
    codes.push({ slots: slotsOf(frequenciesOf(normal, false)), shift: 0, offset: normal[1], escape: 2 * normal[1] + 1 });
  const halfway = kNormals.slice(-2).map((normal) => slotsOf(frequenciesOf(normal, true)));
  for (let c = kFirstShiftedClass; c < kClassCount; ++c) {
    const largest = kNormals[kNormals.length - 2 + (c % 2)]![1];
    codes.push({ slots: halfway[c % 2]!, shift: (c - 16) >> 1, offset: largest + 1, escape: 2 * largest + 2 });
  }
  return codes;
}

const kClassCodes = makeClassCodes();

export class ResidualReader {
  private readonly words: Uint16Array;
  private at = 2 * kLaneCount;
  private readonly states = new Int32Array(kLaneCount);
  private readonly raw: Uint8Array;
  private rawAt = 0;
  private pending = 0;
  private pendingCount = 0;
  private isWhole = true;

  constructor(payload: Uint8Array) {
    const view = new DataView(payload.buffer, payload.byteOffset, payload.byteLength);
    let codedBytes = payload.byteLength >= 4 ? view.getUint32(0, true) : 0;
    if (codedBytes > payload.byteLength - 4 || codedBytes % 2 !== 0 || codedBytes < 4 * kLaneCount) {
      this.isWhole = false;
      codedBytes = 0;
    }
    this.words = new Uint16Array(codedBytes / 2);
    for (let i = 0; i < this.words.length; ++i) this.words[i] = view.getUint16(4 + 2 * i, true);
    for (let lane = 0; lane < kLaneCount; ++lane)
      this.states[lane] = (this.words[2 * lane] ?? 0) | ((this.words[2 * lane + 1] ?? 0) << 16);
    this.raw = payload.subarray(Math.min(4 + codedBytes, payload.byteLength));
  }

  /** The next `count` residuals to `out`. `left`, `above`: classes of the groups before it. Returns the group's class. */
  group(out: Int16Array, count: number, left: number, above: number): number {
    const groupClass = this.readClass(left, above);
    if (groupClass === 0) {
      out.fill(0, 0, count);
      return 0;
    }
    const { slots, shift, offset, escape } = kClassCodes[groupClass]!;
    const { words, states } = this;
    let at = this.at;
    for (let i = 0; i < count; ++i) {
      const lane = i & 3;
      const x = states[lane]!;
      const entry = slots[x & (kSlotCount - 1)]!;
      let next = Math.imul((entry >>> 8) & (kSlotCount - 1), x >>> kSlotBits) + (entry >>> 20);
      if (next >>> 0 < kLow) next = (next << 16) | words[at++]!;
      states[lane] = next;
      const symbol = entry & 0xff;
      if (symbol >= escape) out[i] = this.bits(kRawResidualBits);
      else if (shift > 0) out[i] = ((symbol - offset) << shift) | this.bits(shift);
      else out[i] = symbol - offset;
    }
    this.at = at;
    return groupClass;
  }

  /** A symbol of another table. */
  symbol(slots: Int32Array): number {
    const x = this.states[0]!;
    const entry = slots[x & (kSlotCount - 1)]!;
    let next = Math.imul((entry >>> 8) & (kSlotCount - 1), x >>> kSlotBits) + (entry >>> 20);
    if (next >>> 0 < kLow) next = (next << 16) | this.words[this.at++]!;
    this.states[0] = next;
    return entry & 0xff;
  }

  /** At most 24 raw bits. */
  bits(count: number): number {
    while (this.pendingCount < count) {
      this.pending |= (this.raw[this.rawAt++] ?? 0) << this.pendingCount;
      this.pendingCount += 8;
    }
    const value = this.pending & ((1 << count) - 1);
    this.pending >>>= count;
    this.pendingCount -= count;
    return value;
  }

  /** Whether both streams were read to their ends, no more and no less: else the bytes are damaged. */
  isAtEnd(): boolean {
    return (
      this.isWhole &&
      this.at === this.words.length &&
      this.states.every((x) => x === kLow) &&
      this.rawAt === this.raw.length &&
      this.pending === 0
    );
  }

  private readClass(left: number, above: number): number {
    let expected = 0;
    let codedAs = 7;
    if (left !== 0 && above !== 0) {
      expected = (left + above + 1) >> 1;
      codedAs = 13;
    } else if (left !== 0 || above !== 0) {
      expected = (left + above) >> 1;
      codedAs = 16;
    }
    const { slots, offset, escape } = kClassCodes[codedAs]!;
    const symbol = this.symbol(slots);
    const groupClass = symbol >= escape ? this.bits(6) : symbol - offset + expected;
    return Math.min(Math.max(groupClass, 0), kClassCount - 1);
  }
}

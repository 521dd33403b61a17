// Reads what server/stream/codec/residual_coder wrote: residuals in groups of up to 64, with the fixed code of each group's
// class. proto/README.md describes the format.
import { BitReader, kMaxCodeBits, kSlotLengthMask, slotsOf } from "./bit_reader";

export const kGroupCount = 64;
const kClassCount = 45;
const kSlotMask = (1 << kMaxCodeBits) - 1;
const kLastSparseClass = 4;
const kLastFourClass = 9;
const kLastPairClass = 12;
const kLastUnshiftedClass = 17;
/** Of fours and of pairs; behind it, residuals stand in the code of these classes. */
const kEscape = 81;
const kFourEscapeClass = 13;
const kPairEscapeClass = 15;
const kRawResidualBits = 16;
const kPlaceBits = 6;
const kRawClassBits = 6;
const kSumBits = 16;
const kClassReach = 8;
const kClassEscape = 2 * kClassReach + 2;
/** The largest value with a symbol of its own, of classes 13 to 17. */
const kLargest = [6, 8, 12, 16, 24];

/** Lengths of the symbols' codes of classes 5 to 17, a digit each to the base of 16; proto/README.md has them too. */
const kLengths = [
  "bbbbabbbbb9ba5bbbbbbbbbbbbbbbb86bbbbb5b616b5bbbbb58bbbbbbbbbbbbbbbb5ab9bbbbbabbbb2",
  "bbbb9bbbbb9b948b9bbbbb7bbbbb9b959b6b957515759b6b959b9bbbbb7bbbbb9b849b9bbbbb9bbbb4",
  "abbb8bbbbb9b959b8bbbbb6bbbba9b958b7b856515658b7b859b9abbbb6bbbbb8b849b9bbbbb8bbba4",
  "a9ba8bbbbb8b858a7bbaba6bbbb98b857a6b856515658b6a758b89bbbb6ababb7a758b8bbbbb8ab9a5",
  "a9ba8bbbba8b85897bb9a96bbbba8b85896b856515658b69758b8abbbb69a9bb79858b8abbbb8ab9a5",
  "bbbbbbbbbbbbb9bbbbbbb98bbbbbb9545bbbb9841489bbbb5359bbbbbb89bbbbbbb9bbbbbbbbbbbbb9",
  "bbbbbbbbbbbbbabbbbbba98abbbbb9534abbba83238abbba4358bbbbba89abbbbbbabbbbbbbbbbbbba",
  "bbbbbbbbbbbbabbbbbbb8778bbbba74348bbbb73337bbbb84346abbbb8778bbbbbbbabbbbbbbbbbbba",
  "a98642223589a9",
  "a987653232356789a9",
  "bbba988654333324567899bbb9",
  "bbbbba998775433434334567899aabbbbb",
  "bbbbbbbbba98877665544444444344556677889aabbbbbbbbb",
];
const kClassStepLengths = [
  "1256765566888775786",
  "1766665443556666777",
  "4977665422345567896",
];

function fixedSlots(digits: string): Int32Array {
  return slotsOf([...digits].map((digit) => parseInt(digit, 16)))!;
}

/** 2,048 slots a class, symbol << 4 | length. Fours and pairs: their values instead of the symbol, each raised to be at least
 *  0, in 2 or 4 bits, and below 0 for the escape. */
function makeClassSlots(): Int32Array {
  const all = new Int32Array((kLastUnshiftedClass + 1) << kMaxCodeBits);
  for (let c = kLastSparseClass + 1; c <= kLastUnshiftedClass; ++c) {
    const slots = fixedSlots(kLengths[c - kLastSparseClass - 1]!);
    slots.forEach((entry, slot) => {
      const symbol = entry >> 4;
      let values = symbol;
      if (c <= kLastFourClass)
        values = (symbol % 3) | ((Math.floor(symbol / 3) % 3) << 2) | ((Math.floor(symbol / 9) % 3) << 4) | (Math.floor(symbol / 27) << 6);
      else if (c <= kLastPairClass) values = symbol % 9 | (Math.floor(symbol / 9) << 4);
      // Of fours also their sum, raised by 4.
      if (c <= kLastFourClass) values |= ((values & 3) + ((values >> 2) & 3) + ((values >> 4) & 3) + (values >> 6)) << 8;
      if (c <= kLastPairClass && symbol === kEscape) values = -1;
      all[(c << kMaxCodeBits) + slot] = (values << 4) | (entry & kSlotLengthMask);
    });
  }
  return all;
}

const kClassSlots = makeClassSlots();
const kClassStepSlots = kClassStepLengths.map(fixedSlots);

export class ResidualReader extends BitReader {
  /** Of all residuals. */
  private sum = 0;

  /** To be called last. Whether the sum fits and nothing is left over: else the bytes are damaged. */
  override isAtEnd(): boolean {
    return this.bits(kSumBits) === (this.sum & ((1 << kSumBits) - 1)) && super.isAtEnd();
  }

  /** The next `count` residuals to out[at] and on, and, of damaged bytes, anything up to out[at + 63]. `left`, `above`: classes of the groups before
   *  it. Returns the group's class. */
  group(out: Int16Array, at: number, count: number, left: number, above: number): number {
    this.prepare();
    const groupClass = this.readClass(left, above);
    if (groupClass <= kLastSparseClass) {
      out.fill(0, at, at + count);
      for (let k = 0; k < groupClass; ++k) {
        const place = this.bits(kPlaceBits);
        this.sum -= out[at + place]!; // named twice, it counts once
        out[at + place] = this.bits(1) !== 0 ? -1 : 1;
        this.sum += out[at + place]!;
      }
    } else if (groupClass <= kLastFourClass) {
      this.fours(out, at, at + count, groupClass << kMaxCodeBits);
    } else if (groupClass <= kLastPairClass) {
      this.pairs(out, at, at + count, groupClass << kMaxCodeBits);
    } else {
      this.singles(out, at, at + count, groupClass);
    }
    return groupClass;
  }

  private fours(out: Int16Array, begin: number, end: number, table: number): void {
    const { words } = this;
    let { at, pending, pendingCount } = this;
    let sum = 0;
    for (let i = begin; i < end; i += 4) {
      if (pendingCount < 16) {
        pending |= words[at++]! << pendingCount;
        pendingCount += 16;
      }
      const entry = kClassSlots[table + (pending & kSlotMask)]!;
      pending >>>= entry & kSlotLengthMask;
      pendingCount -= entry & kSlotLengthMask;
      if (entry >= 0) {
        out[i] = ((entry >> 4) & 3) - 1;
        out[i + 1] = ((entry >> 6) & 3) - 1;
        out[i + 2] = ((entry >> 8) & 3) - 1;
        out[i + 3] = ((entry >> 10) & 3) - 1;
        sum += (entry >> 12) - 4;
        continue;
      }
      this.at = at;
      this.pending = pending;
      this.pendingCount = pendingCount;
      this.singles(out, i, i + 4, kFourEscapeClass);
      ({ at, pending, pendingCount } = this);
    }
    this.at = at;
    this.pending = pending;
    this.pendingCount = pendingCount;
    this.sum += sum;
  }

  private pairs(out: Int16Array, begin: number, end: number, table: number): void {
    const { words } = this;
    let { at, pending, pendingCount } = this;
    let sum = 0;
    for (let i = begin; i < end; i += 2) {
      if (pendingCount < 16) {
        pending |= words[at++]! << pendingCount;
        pendingCount += 16;
      }
      const entry = kClassSlots[table + (pending & kSlotMask)]!;
      pending >>>= entry & kSlotLengthMask;
      pendingCount -= entry & kSlotLengthMask;
      if (entry >= 0) {
        const first = ((entry >> 4) & 15) - 4;
        const second = (entry >> 8) - 4;
        out[i] = first;
        out[i + 1] = second;
        sum += first + second;
        continue;
      }
      this.at = at;
      this.pending = pending;
      this.pendingCount = pendingCount;
      this.singles(out, i, i + 2, kPairEscapeClass);
      ({ at, pending, pendingCount } = this);
    }
    this.at = at;
    this.pending = pending;
    this.pendingCount = pendingCount;
    this.sum += sum;
  }

  private singles(out: Int16Array, begin: number, end: number, groupClass: number): void {
    const codedAs = groupClass <= kLastUnshiftedClass ? groupClass : 16 + (groupClass & 1);
    const shift = (groupClass - codedAs) >> 1;
    const half = (1 << shift) >> 1;
    const mask = (1 << shift) - 1;
    const largest = kLargest[codedAs - kLastPairClass - 1]!;
    const escape = 2 * largest + 1;
    const table = codedAs << kMaxCodeBits;
    const { words } = this;
    let { at, pending, pendingCount } = this;
    let sum = 0;
    for (let i = begin; i < end; ++i) {
      if (pendingCount < 16) {
        pending |= words[at++]! << pendingCount;
        pendingCount += 16;
      }
      const entry = kClassSlots[table + (pending & kSlotMask)]!;
      pending >>>= entry & kSlotLengthMask;
      pendingCount -= entry & kSlotLengthMask;
      const symbol = entry >> 4;
      const rawBits = symbol === escape ? kRawResidualBits : shift;
      if (rawBits === 0) {
        out[i] = symbol - largest;
        sum += symbol - largest;
        continue;
      }
      if (pendingCount < 16) {
        pending |= words[at++]! << pendingCount;
        pendingCount += 16;
      }
      if (symbol === escape) out[i] = pending & 0xffff;
      else out[i] = ((symbol - largest) << shift) - half + (pending & mask);
      sum += out[i]!;
      pending >>>= rawBits;
      pendingCount -= rawBits;
    }
    this.at = at;
    this.pending = pending;
    this.pendingCount = pendingCount;
    this.sum += sum;
  }

  private readClass(left: number, above: number): number {
    let expected = kClassReach + 1;
    let slots = kClassStepSlots[0]!;
    if (left !== 0 && above !== 0) {
      expected = (left + above + 1) >> 1;
      slots = kClassStepSlots[2]!;
    } else if (left !== 0 || above !== 0) {
      expected = left + above;
      slots = kClassStepSlots[1]!;
    }
    const symbol = this.symbol(slots);
    if (symbol === 0) return 0;
    const groupClass = symbol === kClassEscape ? this.bits(kRawClassBits) : expected + symbol - kClassReach - 1;
    return Math.min(Math.max(groupClass, 0), kClassCount - 1);
  }
}

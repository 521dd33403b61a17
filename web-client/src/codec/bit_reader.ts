// Bits one behind the other, lowest first, and prefix codes of at most 11 bits in them: what server/stream/codec/bit_stream
// and prefix_code write. Bytes that are damaged give wrong numbers and an end that does not fit, nothing worse.

export const kMaxCodeBits = 11;
const kSlotMask = (1 << kMaxCodeBits) - 1;
const kLengthBits = 4;
/** Of a slot: symbol << 4 | length. */
export const kSlotLengthMask = 15;
/** Zeros behind the last word, so that a run of reads needs one look at where it is. 16 bits each. */
const kPaddingWords = 256;

let scratch = new Uint16Array(1 << 16);

/** One at a time: a reader's words lie in memory that the next one takes. */
export class BitReader {
  /** Little-endian words and, behind them, zeros; the next one; what was taken of them and not used, lowest first. */
  words: Uint16Array;
  at = 0;
  pending = 0;
  pendingCount = 0;
  private readonly endAt: number;
  private isPastEnd = false;

  constructor(private readonly bytes: Uint8Array) {
    this.endAt = (bytes.length + 1) >> 1;
    if (scratch.length < this.endAt + kPaddingWords) scratch = new Uint16Array(2 * (this.endAt + kPaddingWords));
    new Uint8Array(scratch.buffer).set(bytes);
    new Uint8Array(scratch.buffer).fill(0, bytes.length, 2 * (this.endAt + kPaddingWords));
    this.words = scratch;
  }

  /** To be called before reading at most 256 words on. */
  prepare(): void {
    if (this.at <= this.endAt + 1) return; // a reader looks one word ahead
    this.isPastEnd = true;
    this.at = this.endAt + 1;
  }

  /** At most 24. */
  bits(count: number): number {
    if (count > 16) {
      const low = this.bits(16);
      return low | (this.bits(count - 16) << 16);
    }
    this.refill();
    const value = this.pending & ((1 << count) - 1);
    this.pending >>>= count;
    this.pendingCount -= count;
    return value;
  }

  symbol(slots: Int32Array): number {
    this.refill();
    const entry = slots[this.pending & kSlotMask]!;
    this.pending >>>= entry & kSlotLengthMask;
    this.pendingCount -= entry & kSlotLengthMask;
    return entry >> 4;
  }

  /** Whether everything but the filling was read, and nothing beyond. */
  isAtEnd(): boolean {
    const left = 8 * this.bytes.length - (16 * this.at - this.pendingCount);
    return !this.isPastEnd && left >= 0 && left < 8 && this.pending === 0;
  }

  private refill(): void {
    if (this.pendingCount >= 16) return;
    this.prepare();
    this.pending |= this.words[this.at++]! << this.pendingCount;
    this.pendingCount += 16;
  }
}

/** By the next bits: symbol << 4 | length. Undefined where the lengths are not those of a code in which every sequence of
 *  bits has a meaning. */
export function slotsOf(lengths: ArrayLike<number>): Int32Array | undefined {
  const counts = new Int32Array(16);
  for (let symbol = 0; symbol < lengths.length; ++symbol) ++counts[lengths[symbol]!]!;
  counts[0] = 0;
  const next = new Int32Array(16);
  let code = 0;
  for (let length = 1; length <= 15; ++length) {
    code = (code + counts[length - 1]!) << 1;
    next[length] = code;
    if (length > kMaxCodeBits && counts[length]! > 0) return undefined;
    if (length === kMaxCodeBits && code + counts[length]! !== 1 << kMaxCodeBits) return undefined;
  }
  const slots = new Int32Array(1 << kMaxCodeBits);
  for (let symbol = 0; symbol < lengths.length; ++symbol) {
    const length = lengths[symbol]!;
    if (length === 0) continue;
    let reversed = 0;
    for (let bit = 0, c = next[length]!++; bit < length; ++bit, c >>= 1) reversed = (reversed << 1) | (c & 1);
    for (let slot = reversed; slot < slots.length; slot += 1 << length) slots[slot] = (symbol << 4) | length;
  }
  return slots;
}

/** A frame's own code, from its bits; undefined where they are damaged. */
export function readFittedCode(symbolCount: number, reader: BitReader): Int32Array | undefined {
  const lengths = new Uint8Array(symbolCount);
  for (let symbol = 0; symbol < symbolCount; ++symbol)
    if (symbol < 2 || reader.bits(1) !== 0) lengths[symbol] = reader.bits(kLengthBits);
  return slotsOf(lengths);
}

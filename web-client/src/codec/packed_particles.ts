// The particles' packed form → the 12 bytes a particle of their plain one, in the quanta of the packed: the reading half of
// server/stream/codec/particle_cells.
import { readFittedCode, type BitReader } from "./bit_reader";
import type { FrameHeader, ParticleHeader } from "./frames";
import { malformed, type Malformed } from "./malformed";
import { kGroupCount, ResidualReader } from "./residual_reader";

const kHalfSymbolCount = 256;
const kGapSymbolCount = 25;
const kManyCount = 3;
const kMaxGammaBits = 23;
const kWordsPerParticle = 6;
const kMaxSignedByte = 127;

function readGamma(reader: BitReader): number {
  let bits = 0;
  while (bits < kMaxGammaBits && reader.bits(1) === 0) ++bits;
  return ((1 << bits) | reader.bits(bits)) - 1;
}

export interface PackedParticles extends FrameHeader {
  count: number;
  minM: [number, number, number];
  /** Along x, y, z. */
  cellsCount: [number, number, number];
  cellM: number;
  offsetBits: number;
  velocityQuantumMps: number;
  radiusM: number;
  payload: Uint8Array;
}

/** One attribute of the particles from group to group: values are the mean plus what differs from it. */
class Attribute {
  readonly differences = new Int16Array(kGroupCount);
  mean = 0;
  private readonly step = new Int16Array(kGroupCount);
  private meanClass = 0;
  private groupClass = 0;

  read(reader: ResidualReader, count: number): void {
    this.meanClass = reader.group(this.step, 0, 1, this.meanClass, this.meanClass);
    this.mean = ((this.mean + this.step[0]!) << 16) >> 16;
    this.groupClass = reader.group(this.differences, 0, count, this.groupClass, this.groupClass);
  }
}

/** A particle's place is that of its eighth and, still to come, the bits below. False: damaged. */
function readCells(reader: BitReader, packed: PackedParticles, words: Uint16Array): boolean {
  const { count, cellsCount, offsetBits } = packed;
  const halfSlots = readFittedCode(kHalfSymbolCount, reader);
  if (!halfSlots) return false;
  const gapSlots = readFittedCode(kGapSymbolCount, reader);
  if (!gapSlots) return false;
  const [cellsX, cellsY, cellsZ] = cellsCount;
  const low = offsetBits - 1;
  let x = 0;
  let y = -1;
  let z = 0;
  for (let i = 0, at = 0; i < count; ) {
    const gapBits = reader.symbol(gapSlots);
    y += 1 + (gapBits > 1 ? (1 << (gapBits - 1)) | reader.bits(gapBits - 1) : gapBits);
    if (y >= cellsY) {
      x += Math.floor(y / cellsY);
      y %= cellsY;
      z += Math.floor(x / cellsX);
      x %= cellsX;
      if (z >= cellsZ) return false;
    }
    const lowHalf = reader.symbol(halfSlots);
    let halves = lowHalf | (reader.symbol(halfSlots) << 8);
    if (halves === 0) return false;
    for (let eighth = 0; halves !== 0; ++eighth, halves >>= 2) {
      let inEighth = halves & 3;
      if (inEighth === 0) continue;
      if (inEighth === kManyCount) inEighth += readGamma(reader);
      if (inEighth > count - i) return false;
      i += inEighth;
      const atX = (x * 2 + (eighth >> 2)) << low;
      const atY = (y * 2 + (eighth & 1)) << low;
      const atZ = (z * 2 + ((eighth >> 1) & 1)) << low;
      for (; inEighth > 0; --inEighth, at += kWordsPerParticle) {
        words[at] = atX;
        words[at + 1] = atZ;
        words[at + 2] = atY;
      }
    }
  }
  return true;
}

function readOffsets(reader: BitReader, packed: PackedParticles, words: Uint16Array): void {
  const low = packed.offsetBits - 1;
  const mask = (1 << low) - 1;
  for (let at = 0; at < words.length; at += kWordsPerParticle) {
    const offsets = reader.bits(3 * low);
    words[at]! |= offsets & mask;
    words[at + 1]! |= (offsets >> low) & mask;
    words[at + 2]! |= offsets >> (2 * low);
  }
}

const kTints = Uint8Array.from({ length: 8 }, (_, tint) => Math.floor((tint * 255) / 7));

function readAttributes(reader: ResidualReader, count: number, words: Uint16Array): void {
  const [vx, vy, vz, foam, tint] = [new Attribute(), new Attribute(), new Attribute(), new Attribute(), new Attribute()] as const;
  for (let begin = 0; begin < count; begin += kGroupCount) {
    const inGroup = Math.min(kGroupCount, count - begin);
    vx.read(reader, inGroup);
    vy.read(reader, inGroup);
    vz.read(reader, inGroup);
    foam.read(reader, inGroup);
    tint.read(reader, inGroup);
    let at = kWordsPerParticle * begin + 3;
    for (let k = 0; k < inGroup; ++k, at += kWordsPerParticle) {
      words[at] = byteOf(vx.mean + vx.differences[k]!) | (byteOf(vy.mean + vy.differences[k]!) << 8);
      words[at + 1] = byteOf(vz.mean + vz.differences[k]!) | (kTints[clamp(tint.mean + tint.differences[k]!, 7)]! << 8);
      words[at + 2] = clamp(foam.mean + foam.differences[k]!, 3) * 85;
    }
  }
}

/** Bounds were checked; what is left to find is damage of the payload. */
export function unpackParticles(packed: PackedParticles): { kind: "particles"; header: ParticleHeader; payload: Uint8Array } | Malformed {
  const { tick, timeS, serverTimeS, level, count, minM, cellsCount, cellM, offsetBits, velocityQuantumMps, radiusM, payload } = packed;
  const reader = new ResidualReader(payload);
  const words = new Uint16Array(kWordsPerParticle * count);
  const hasCells = readCells(reader, packed, words);
  if (hasCells) {
    readOffsets(reader, packed, words);
    readAttributes(reader, count, words);
  }
  if (!hasCells || !reader.isAtEnd()) return malformed(`particles: the payload does not hold ${count} of them`);
  // Places are whole quanta, so that the largest u16 lies 65,535 of them above the first; likewise speeds.
  const quantumM = cellM / 2 ** offsetBits;
  const first = minM.map((min) => min + quantumM / 2) as ParticleHeader["wordMinM"];
  const header: ParticleHeader = {
    tick,
    timeS,
    serverTimeS,
    level,
    count,
    minM,
    maxM: minM.map((min, axis) => min + cellsCount[axis]! * cellM) as ParticleHeader["maxM"],
    wordMinM: first,
    wordMaxM: first.map((min) => min + 65535 * quantumM) as ParticleHeader["wordMaxM"],
    maxSpeedMps: kMaxSignedByte * velocityQuantumMps,
    radiusM,
  };
  return { kind: "particles", header, payload: new Uint8Array(words.buffer) };
}

/** A signed byte's bits. */
function byteOf(value: number): number {
  return (value > kMaxSignedByte ? kMaxSignedByte : value < -kMaxSignedByte ? -kMaxSignedByte : value) & 0xff;
}

function clamp(value: number, most: number): number {
  return value < 0 ? 0 : value > most ? most : value;
}

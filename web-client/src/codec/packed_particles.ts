// The particles' packed form → the 12 bytes a particle of their plain one, in the quanta of the packed: the reading half of
// server/stream/codec/particle_cells.
import type { ParticleHeader } from "./frames";
import { malformed, type Malformed } from "./malformed";
import { ResidualReader, slotsOf } from "./residual_reader";

const kSlotCount = 4096;
const kHalfSymbolCount = 256;
const kGapSymbolCount = 25;
const kManyCount = 3;
const kGroupCount = 64;
const kLevelBits = 5;
const kMaxGammaBits = 23;
const kWordsPerParticle = 6;
const kMaxSignedByte = 127;

/** A frame's own table, from its raw bits: for each symbol that occurs how often, in steps of a factor of sqrt 2. */
function readFittedTable(symbolCount: number, reader: ResidualReader): Int32Array {
  const weights: number[] = [];
  for (let symbol = 0; symbol < symbolCount; ++symbol) {
    const isThere = symbol < 2 || reader.bits(1) !== 0;
    const level = isThere ? Math.max(reader.bits(kLevelBits), 1) : 0;
    weights.push(level > 0 ? (level % 2 !== 0 ? 256 : 362) * 2 ** ((level - 1) >> 1) : 0);
  }
  const sum = weights.reduce((a, b) => a + b, 0);
  const frequencies = weights.map((weight) => (weight > 0 ? 1 + Math.floor((weight * (kSlotCount - 256)) / sum) : 0));
  const used = frequencies.reduce((a, b) => a + b, 0);
  const heaviest = frequencies.indexOf(Math.max(...frequencies));
  frequencies[heaviest]! += kSlotCount - used;
  return slotsOf(frequencies);
}

function readGamma(reader: ResidualReader): number {
  let bits = 0;
  while (bits < kMaxGammaBits && reader.bits(1) === 0) ++bits;
  return ((1 << bits) | reader.bits(bits)) - 1;
}

export interface PackedParticles {
  tick: bigint;
  timeS: number;
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

/** One attribute of the particles from group to group. */
class Attribute {
  readonly values = new Int16Array(kGroupCount);
  private readonly step = new Int16Array(1);
  private mean = 0;
  private meanClass = 0;
  private groupClass = 0;

  read(reader: ResidualReader, count: number): void {
    this.meanClass = reader.group(this.step, 1, this.meanClass, this.meanClass);
    this.mean = ((this.mean + this.step[0]!) << 16) >> 16;
    this.groupClass = reader.group(this.values, count, this.groupClass, this.groupClass);
    for (let i = 0; i < count; ++i) this.values[i]! += this.mean;
  }
}

/** Bounds were checked; what is left to find is damage of the payload. */
export function unpackParticles(packed: PackedParticles): { kind: "particles"; header: ParticleHeader; payload: Uint8Array } | Malformed {
  const { tick, timeS, count, minM, cellsCount, cellM, offsetBits, velocityQuantumMps, radiusM, payload } = packed;
  const damaged = malformed(`particles: the payload does not hold ${count} of them`);
  const reader = new ResidualReader(payload);
  const words = new Uint16Array(kWordsPerParticle * count);
  const halfSlots = readFittedTable(kHalfSymbolCount, reader);
  const gapSlots = readFittedTable(kGapSymbolCount, reader);
  const [cellsX, cellsY, cellsZ] = cellsCount;
  const cellCount = cellsX * cellsY * cellsZ;
  const low = offsetBits - 1;
  const mask = (1 << low) - 1;
  let cell = 0;
  for (let i = 0; i < count; ++cell) {
    const gapBits = reader.symbol(gapSlots);
    cell += gapBits > 1 ? (1 << (gapBits - 1)) | reader.bits(gapBits - 1) : gapBits;
    if (cell >= cellCount) return damaged;
    const y = cell % cellsY;
    const column = (cell - y) / cellsY;
    const z = column % cellsZ;
    const x = (column - z) / cellsZ;
    const begin = i;
    const lowHalf = reader.symbol(halfSlots);
    const halves = lowHalf | (reader.symbol(halfSlots) << 8);
    for (let eighth = 0; eighth < 8; ++eighth) {
      let inEighth = (halves >> (2 * eighth)) & 3;
      if (inEighth === 0) continue;
      if (inEighth === kManyCount) inEighth += readGamma(reader);
      if (inEighth > count - i) return damaged;
      const atX = (x * 2 + (eighth >> 2)) << low;
      const atY = (y * 2 + (eighth & 1)) << low;
      const atZ = (z * 2 + ((eighth >> 1) & 1)) << low;
      for (const end = i + inEighth; i < end; ++i) {
        const offsets = reader.bits(3 * low);
        const at = kWordsPerParticle * i;
        words[at] = atX | (offsets & mask);
        words[at + 1] = atZ | ((offsets >> low) & mask);
        words[at + 2] = atY | (offsets >> (2 * low));
      }
    }
    if (i === begin) return damaged;
  }
  const attributes = [new Attribute(), new Attribute(), new Attribute(), new Attribute(), new Attribute()] as const;
  const [vx, vy, vz, foam, tint] = attributes.map((a) => a.values) as [Int16Array, Int16Array, Int16Array, Int16Array, Int16Array];
  for (let begin = 0; begin < count; begin += kGroupCount) {
    const inGroup = Math.min(kGroupCount, count - begin);
    for (const attribute of attributes) attribute.read(reader, inGroup);
    for (let k = 0; k < inGroup; ++k) {
      const at = kWordsPerParticle * (begin + k);
      words[at + 3] = byteOf(vx[k]!) | (byteOf(vy[k]!) << 8);
      words[at + 4] = byteOf(vz[k]!) | (Math.floor((Math.min(Math.max(tint[k]!, 0), 7) * 255) / 7) << 8);
      words[at + 5] = Math.min(Math.max(foam[k]!, 0), 3) * 85;
    }
  }
  if (!reader.isAtEnd()) return damaged;
  // Places are whole quanta, so that the largest u16 lies 65,535 of them above the first; likewise speeds.
  const quantumM = cellM / 2 ** offsetBits;
  const first = minM.map((min) => min + quantumM / 2) as ParticleHeader["wordMinM"];
  const header: ParticleHeader = {
    tick,
    timeS,
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
  return Math.min(Math.max(value, -kMaxSignedByte), kMaxSignedByte) & 0xff;
}

// Packed particles → the 12-byte records of plain ones, with the packed frame's quanta.
import { ParticleReader } from "./frame_reader";
import type { PackedParticles, ParticleHeader } from "./frame_types";
import { malformed, type Malformed } from "./malformed";

const kMaxSignedByte = 127;
const kMaxWord = 65535;

/** Header and ranges have been checked, so only the payload can be damaged. The result is valid until the reader's next call. */
export function unpackParticles(reader: ParticleReader, packed: PackedParticles): { header: ParticleHeader; payload: Uint8Array } | Malformed {
  const { count, minM, cellsCount, cellM, offsetBits, velocityQuantumMps, radiusM } = packed;
  const payload = reader.read(packed.payload, count, cellsCount, offsetBits);
  if (!payload) return malformed(`particles: the payload does not hold ${count} of them`);
  // The reader writes positions in whole quanta, so the word 65535 lies 65,535 quanta above the word 0; likewise velocities.
  const quantumM = cellM / 2 ** offsetBits;
  const wordMinM = minM.map((min) => min + quantumM / 2) as ParticleHeader["wordMinM"];
  const header: ParticleHeader = {
    ...packed.header,
    count,
    minM,
    maxM: minM.map((min, axis) => min + cellsCount[axis]! * cellM) as ParticleHeader["maxM"],
    wordMinM,
    wordMaxM: wordMinM.map((min) => min + kMaxWord * quantumM) as ParticleHeader["wordMaxM"],
    maxSpeedMps: kMaxSignedByte * velocityQuantumMps,
    radiusM,
  };
  return { header, payload };
}

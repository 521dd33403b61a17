// The particles' packed form → the 12 bytes a particle of their plain one, in the quanta of the packed.
import { ParticleReader } from "./frame_reader";
import type { FrameHeader, ParticleHeader } from "./frames";
import { malformed, type Malformed } from "./malformed";

const kMaxSignedByte = 127;

let reader: ParticleReader | undefined;

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

/** Bounds were checked; what is left to find is damage of the payload. What comes back holds until the next call. */
export function unpackParticles(packed: PackedParticles): { kind: "particles"; header: ParticleHeader; payload: Uint8Array } | Malformed {
  const { tick, stateId, timeS, serverTimeS, level, count, minM, cellsCount, cellM, offsetBits, velocityQuantumMps, radiusM, payload } = packed;
  reader ??= new ParticleReader();
  const words = reader.read(payload, count, cellsCount, offsetBits);
  if (!words) return malformed(`particles: the payload does not hold ${count} of them`);
  // Places are whole quanta, so that the largest u16 lies 65,535 of them above the first; likewise speeds.
  const quantumM = cellM / 2 ** offsetBits;
  const first = minM.map((min) => min + quantumM / 2) as ParticleHeader["wordMinM"];
  const header: ParticleHeader = {
    tick,
    stateId,
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
  return { kind: "particles", header, payload: words };
}

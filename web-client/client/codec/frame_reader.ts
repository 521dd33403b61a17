// The readers of packed frames: server/bitstream/decode, compiled to WebAssembly (scripts/wasm.mjs). One instance per layer.
import { kFrameReaderBase64 } from "../gen/frame_reader_wasm";
import { kFloaterBytes, type PackedFloaters, type PlaneExtents } from "./frame_types";

/** Weights of one packed plane. */
export const kWeightCount = 10;

/** server/bitstream/wasm/frame_reader.cpp. All numbers are addresses in `memory`, counts, or booleans as 0 and 1. */
interface Exports {
  memory: WebAssembly.Memory;
  prepareParticles(count: number, payloadBytes: number): number;
  readParticles(count: number, cellsX: number, cellsY: number, cellsZ: number, offsetBits: number): number;
  preparePlane(countX: number, countZ: number, payloadBytes: number): number;
  weights(): number;
  earlierWeights(): number;
  readKeyframePlane(): number;
  readDeltaPlane(): number;
  surfaceSamples(): number;
  foamSamples(): number;
  prepareFloaters(payloadBytes: number): number;
  readKeyframeFloaters(count: number, rotationBits: number): number;
  readDeltaFloaters(count: number, rotationBits: number, motionWeight: number): number;
  prepareChecksum(payloadBytes: number): number;
  checksum(): number;
}

let compiled: WebAssembly.Module | undefined;

function instantiate(): Exports {
  compiled ??= new WebAssembly.Module(Uint8Array.from(atob(kFrameReaderBase64), (letter) => letter.charCodeAt(0)));
  return new WebAssembly.Instance(compiled).exports as unknown as Exports;
}

/** Returns one line for the user if packed frames cannot be read here. */
export function readerFault(): string | undefined {
  try {
    instantiate();
    return undefined;
  } catch (error) {
    return `packed frames cannot be read here, for want of WebAssembly with SIMD (${error instanceof Error ? error.message : String(error)})`;
  }
}

/** One instance of the module. Results are views into its memory: copy them before the next frame is read. */
class Reader {
  protected readonly exports = instantiate();

  /** False if there was no memory for the payload (address 0). */
  protected put(payload: Uint8Array, at: number): boolean {
    if (at === 0) return false;
    this.view(at, payload.length).set(payload);
    return true;
  }

  protected view(at: number, bytesCount: number): Uint8Array {
    return new Uint8Array(this.exports.memory.buffer, at, bytesCount);
  }
}

class ChecksumReader extends Reader {
  /** Undefined if there is no memory for the payload. */
  read(payload: Uint8Array): number | undefined {
    if (!this.put(payload, this.exports.prepareChecksum(payload.length))) return undefined;
    return this.exports.checksum() >>> 0;
  }
}

let checksumReader: ChecksumReader | undefined;

/** Returns the CRC-32C (Castagnoli, reflected polynomial 0x82F63B78), an unsigned 32-bit number; 0xE3069283 for "123456789". */
export function crc32c(bytes: Uint8Array): number {
  checksumReader ??= new ChecksumReader();
  const crc = checksumReader.read(bytes);
  if (crc === undefined) throw new RangeError(`no memory for a payload of ${bytes.length} bytes`);
  return crc;
}

export class ParticleReader extends Reader {
  /** 12 bytes per particle; undefined if the payload is damaged. */
  read(payload: Uint8Array, count: number, cellsCount: readonly [number, number, number], offsetBits: number): Uint8Array | undefined {
    if (!this.put(payload, this.exports.prepareParticles(count, payload.length))) return undefined;
    const at = this.exports.readParticles(count, ...cellsCount, offsetBits);
    return at === 0 ? undefined : this.view(at, 12 * count);
  }
}

/** Objects in the water. After a damaged frame only a keyframe can be read. */
export class FloaterReader extends Reader {
  /** kFloaterBytes for each object; undefined if the payload is damaged. */
  read({ payload, header: { count }, baseTick, rotationBits, motionWeight }: PackedFloaters): Uint8Array | undefined {
    if (!this.put(payload, this.exports.prepareFloaters(payload.length))) return undefined;
    const at = baseTick === undefined ? this.exports.readKeyframeFloaters(count, rotationBits) : this.exports.readDeltaFloaters(count, rotationBits, motionWeight);
    return at === 0 ? undefined : this.view(at, kFloaterBytes * count);
  }
}

/** The planes of one layer. After a damaged plane only a keyframe can be read. */
export class PlaneReader extends Reader {
  readKeyframe(payload: Uint8Array, plane: PlaneExtents, weights: readonly number[], earlierWeights: readonly number[]): boolean {
    if (!this.put(payload, this.exports.preparePlane(plane.resolutionCount, plane.countZ, payload.length))) return false;
    this.putWeights(weights, this.exports.weights());
    this.putWeights(earlierWeights, this.exports.earlierWeights());
    return this.exports.readKeyframePlane() !== 0;
  }

  readDelta(payload: Uint8Array, plane: PlaneExtents, weights: readonly number[]): boolean {
    if (!this.put(payload, this.exports.preparePlane(plane.resolutionCount, plane.countZ, payload.length))) return false;
    this.putWeights(weights, this.exports.weights());
    return this.exports.readDeltaPlane() !== 0;
  }

  /** Samples of the plane read last, two bytes each. */
  surface({ resolutionCount, countZ }: PlaneExtents): Uint8Array {
    return this.view(this.exports.surfaceSamples(), 2 * resolutionCount * countZ);
  }

  /** Samples of the plane read last, one byte each. */
  foam({ resolutionCount, countZ }: PlaneExtents): Uint8Array {
    return this.view(this.exports.foamSamples(), resolutionCount * countZ);
  }

  private putWeights(weights: readonly number[], at: number): void {
    new Int32Array(this.exports.memory.buffer, at, kWeightCount).set(weights);
  }
}

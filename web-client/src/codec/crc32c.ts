// CRC-32C (Castagnoli, reflected polynomial 0x82F63B78): checks a frame's payload in the worker.
import { ChecksumReader } from "./frame_reader";

let reader: ChecksumReader | undefined;

/** Returns an unsigned 32-bit number; 0xE3069283 for "123456789". */
export function crc32c(bytes: Uint8Array): number {
  reader ??= new ChecksumReader();
  const crc = reader.read(bytes);
  if (crc === undefined) throw new RangeError(`no memory for a payload of ${bytes.length} bytes`);
  return crc;
}

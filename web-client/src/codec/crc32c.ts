// CRC-32C (Castagnoli, reflected polynomial 0x82F63B78), four bytes a turn: checks a frame's payload in the worker.

const kTables = buildTables();

function buildTables(): Uint32Array[] {
  const tables = [0, 1, 2, 3].map(() => new Uint32Array(256));
  const [t0, t1, t2, t3] = tables as [Uint32Array, Uint32Array, Uint32Array, Uint32Array];
  for (let i = 0; i < 256; ++i) {
    let crc = i;
    for (let bit = 0; bit < 8; ++bit) crc = crc & 1 ? (crc >>> 1) ^ 0x82f63b78 : crc >>> 1;
    t0[i] = crc;
  }
  for (let i = 0; i < 256; ++i) {
    t1[i] = (t0[i]! >>> 8) ^ t0[t0[i]! & 0xff]!;
    t2[i] = (t1[i]! >>> 8) ^ t0[t1[i]! & 0xff]!;
    t3[i] = (t2[i]! >>> 8) ^ t0[t2[i]! & 0xff]!;
  }
  return tables;
}

/** Checksum of the bytes as an unsigned 32-bit number; of "123456789" it is 0xE3069283. */
export function crc32c(bytes: Uint8Array): number {
  const [t0, t1, t2, t3] = kTables as [Uint32Array, Uint32Array, Uint32Array, Uint32Array];
  let crc = 0xffffffff;
  const wholeEnd = bytes.length - (bytes.length % 4);
  let at = 0;
  for (; at < wholeEnd; at += 4) {
    crc ^= bytes[at]! | (bytes[at + 1]! << 8) | (bytes[at + 2]! << 16) | (bytes[at + 3]! << 24);
    crc = t3[crc & 0xff]! ^ t2[(crc >>> 8) & 0xff]! ^ t1[(crc >>> 16) & 0xff]! ^ t0[crc >>> 24]!;
  }
  for (; at < bytes.length; ++at) crc = (crc >>> 8) ^ t0[(crc ^ bytes[at]!) & 0xff]!;
  return ~crc >>> 0;
}

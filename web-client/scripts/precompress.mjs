// Compresses the built page: writes FILE.br and FILE.gz beside each file of dist that becomes smaller, which the server sends instead
// (server/http/include/spindrift/http/static_files.h). Prints the bytes of the page in each coding, without the stills of scenes, of which it loads one.
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";

const dist = path.join(path.dirname(path.dirname(fileURLToPath(import.meta.url))), "dist");
const kCodings = {
  ".br": (bytes) => brotliCompressSync(bytes, { params: { [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length } }),
  ".gz": (bytes) => gzipSync(bytes, { level: constants.Z_BEST_COMPRESSION }),
};

const sums = { plain: 0, ...Object.fromEntries(Object.keys(kCodings).map((suffix) => [suffix, 0])) };
for (const entry of readdirSync(dist, { recursive: true, withFileTypes: true })) {
  const file = path.join(entry.parentPath, entry.name);
  if (!entry.isFile() || Object.keys(kCodings).includes(path.extname(file))) continue;
  const bytes = readFileSync(file);
  if (path.extname(file) === ".webp") continue;
  sums.plain += bytes.length;
  for (const [suffix, compress] of Object.entries(kCodings)) {
    const compressed = compress(bytes);
    if (compressed.length < bytes.length) writeFileSync(file + suffix, compressed);
    sums[suffix] += Math.min(compressed.length, bytes.length);
  }
}
console.log(`page: ${Object.entries(sums).map(([coding, count]) => `${count} bytes ${coding}`).join(", ")}`);

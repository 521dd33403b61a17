// Compiles the frame reader (server/bitstream/decode, with the checksum of server/core) to WebAssembly and writes it to client/gen as
// base64 text: the worker needs no second request, and tests and benchmarks use the same module. Needs Debian's clang, lld and
// libc++ for wasm32; CLANG names another clang.
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { fileURLToPath } from "node:url";

const clientRoot = path.dirname(path.dirname(fileURLToPath(import.meta.url)));
const bitstreamRoot = path.join(clientRoot, "..", "server", "bitstream");
const coreRoot = path.join(clientRoot, "..", "server", "core");
const outFile = path.join(clientRoot, "client", "gen", "frame_reader_wasm.ts");
const clang = process.env.CLANG ?? "clang";
const kStackBytes = 64 * 1024;
const kMemoryMaxBytes = 1024 * 1024 * 1024;

const sources = [
  path.join(coreRoot, "crc32c_tables.cpp"),
  ...["decode", "wasm"].flatMap((folder) =>
    readdirSync(path.join(bitstreamRoot, folder)).filter((name) => name.endsWith(".cpp")).map((name) => path.join(bitstreamRoot, folder, name)),
  ),
];
const options = [
  "--target=wasm32-wasi", "-std=c++20", "-O3", "-msimd128", "-mbulk-memory",
  "-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Wno-sign-conversion", "-Werror",
  "-nostdlib", "-Wl,--no-entry", "-Wl,--strip-all", "-Wl,--stack-first", `-Wl,-z,stack-size=${kStackBytes}`, `-Wl,--max-memory=${kMemoryMaxBytes}`,
];

const folder = mkdtempSync(path.join(tmpdir(), "spindrift-wasm-"));
try {
  const module = path.join(folder, "frame_reader.wasm");
  const run = spawnSync(clang, [...options, `-I${bitstreamRoot}`, `-I${path.join(bitstreamRoot, "include")}`, `-I${path.join(coreRoot, "include")}`, ...sources, "-o", module], { stdio: "inherit" });
  if (run.error || run.status !== 0) {
    const why = run.error ? run.error.message : `exit code ${run.status}`;
    console.error(`wasm: "${clang}" made no WebAssembly (${why}); it takes Debian's clang, lld and libc++-dev-wasm32`);
    process.exit(run.status || 2);
  }
  mkdirSync(path.dirname(outFile), { recursive: true });
  const text = readFileSync(module).toString("base64");
  writeFileSync(outFile, `// Made by scripts/wasm.mjs.\nexport const kFrameReaderBase64 =\n  "${text}";\n`);
} finally {
  rmSync(folder, { recursive: true, force: true });
}

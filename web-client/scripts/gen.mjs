// Generates client/gen from proto/: messages by Debian's protoc with the npm plugin, and the ranges of the fields that users set as plain
// numbers, so that the page reads them without a library. PROTOC names another protoc.
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { createFileRegistry, fromBinary, getOption, hasOption } from "@bufbuild/protobuf";
import { FileDescriptorSetSchema } from "@bufbuild/protobuf/wkt";

const client_root = dirname(dirname(fileURLToPath(import.meta.url)));
const proto_root = join(client_root, "..", "proto");
const out_root = join(client_root, "client", "gen");
const protoc = process.env.PROTOC ?? "protoc";

/** One object per message that has such fields: `kSplashRanges.radiusM.max`. The page's bundle keeps those that it uses. */
function rangesOf(descriptors) {
  const registry = createFileRegistry(descriptors);
  const parameter = registry.getExtension("spindrift.v1.parameter");
  const lines = [];
  for (const message of registry) {
    if (message.kind !== "message" || !message.typeName.startsWith("spindrift.v1.")) continue;
    const fields = message.fields.filter((field) => hasOption(field, parameter)).map((field) => {
      const { label, unit, min, max, step, default: fallback } = getOption(field, parameter);
      return `  ${field.localName}: ${JSON.stringify({ label, unit, min, max, step, default: fallback })},\n`;
    });
    if (fields.length > 0) lines.push(`export const k${message.name}Ranges = {\n${fields.join("")}};\n`);
  }
  return `// Made by scripts/gen.mjs: the options of proto/spindrift/v1/options.proto.\n${lines.join("")}`;
}

mkdirSync(out_root, { recursive: true });
const folder = mkdtempSync(join(tmpdir(), "spindrift-proto-"));
try {
  const set = join(folder, "spindrift.pb");
  const run = spawnSync(
    protoc,
    [
      `--plugin=protoc-gen-es=${join(client_root, "node_modules", ".bin", "protoc-gen-es")}`,
      `--es_out=${out_root}`,
      "--es_opt=target=ts",
      `--descriptor_set_out=${set}`,
      "--include_imports",
      `--proto_path=${proto_root}`,
      ...["options", "scene", "wire", "api"].map((name) => `spindrift/v1/${name}.proto`),
    ],
    { stdio: "inherit" },
  );
  if (run.error) console.error(`gen: cannot run "${protoc}" (${run.error.message}); install Debian's protobuf-compiler or set PROTOC`);
  if (run.error || run.status !== 0) process.exitCode = run.status || 2;
  else writeFileSync(join(out_root, "ranges.ts"), rangesOf(fromBinary(FileDescriptorSetSchema, readFileSync(set))));
} finally {
  rmSync(folder, { recursive: true, force: true });
}

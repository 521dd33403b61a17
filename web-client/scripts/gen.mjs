// Generates src/gen from proto/: Debian's protoc with the npm plugin. PROTOC names another protoc.
import { spawnSync } from "node:child_process";
import { mkdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const client_root = dirname(dirname(fileURLToPath(import.meta.url)));
const proto_root = join(client_root, "..", "proto");
const out_root = join(client_root, "src", "gen");
const protoc = process.env.PROTOC ?? "protoc";

mkdirSync(out_root, { recursive: true });
const run = spawnSync(
  protoc,
  [
    `--plugin=protoc-gen-es=${join(client_root, "node_modules", ".bin", "protoc-gen-es")}`,
    `--es_out=${out_root}`,
    "--es_opt=target=ts",
    `--proto_path=${proto_root}`,
    ...["options", "scene", "wire", "api"].map((name) => `spindrift/v1/${name}.proto`),
  ],
  { stdio: "inherit" },
);
if (run.error) {
  console.error(`gen: cannot run "${protoc}" (${run.error.message}); install Debian's protobuf-compiler or set PROTOC`);
  process.exit(2);
}
process.exit(run.status ?? 1);

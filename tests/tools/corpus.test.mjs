// The seeds of the fuzz targets are those that make_corpus.py writes.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { describe, it } from "node:test";

import { repository } from "./workshop.mjs";

/** Contents of all files, by their path in the folder. */
function contentsOf(folder) {
  const files = readdirSync(folder, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile());
  const paths = files.map((entry) => join(entry.parentPath, entry.name).slice(folder.length + 1)).sort();
  return Object.fromEntries(paths.map((path) => [path, readFileSync(join(folder, path)).toString("base64")]));
}

describe("the seeds of the fuzz targets", () => {
  it("are what make_corpus.py writes: no more, no fewer, byte by byte", () => {
    const folder = mkdtempSync(join(tmpdir(), "spindrift corpus "));
    try {
      const { status, stderr } = spawnSync("python3", [join(repository, "tests/fuzz/make_corpus.py"), folder], { encoding: "utf8" });
      assert.equal(status, 0, stderr);
      assert.deepEqual(contentsOf(join(repository, "tests/fuzz/corpus")), contentsOf(folder));
    } finally {
      rmSync(folder, { recursive: true });
    }
  });
});

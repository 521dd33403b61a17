// The seeds of the fuzz targets, which make_corpus.py writes.
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
  it("are there for every target, and the same bytes whenever they are written", () => {
    const folders = [1, 2].map(() => mkdtempSync(join(tmpdir(), "spindrift corpus ")));
    try {
      for (const folder of folders) {
        const { status, stderr } = spawnSync("python3", [join(repository, "tests/fuzz/make_corpus.py"), folder], { encoding: "utf8" });
        assert.equal(status, 0, stderr);
      }
      const [first, second] = folders.map(contentsOf);
      assert.deepEqual(first, second);
      const targets = readFileSync(join(repository, "tests/fuzz/CMakeLists.txt"), "utf8").matchAll(/^spindrift_fuzz\(NAME (\w+)/gm);
      assert.deepEqual([...new Set(Object.keys(first).map((path) => path.split("/")[0]))], [...targets].map((match) => match[1]).sort());
    } finally {
      for (const folder of folders) rmSync(folder, { recursive: true });
    }
  });
});

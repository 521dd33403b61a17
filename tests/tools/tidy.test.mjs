// tidy.py: findings are printed, reported per file, and fail the run.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { chmodSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, describe, it } from "node:test";

import { repository } from "./workshop.mjs";

describe("tidy.py", () => {
  const folder = mkdtempSync(join(tmpdir(), "tidy "));
  after(() => rmSync(folder, { recursive: true, force: true }));
  const report = join(folder, "report.xml");
  // Stands for clang-tidy: a finding in bad.cpp, its own failure at broken.cpp.
  writeFileSync(
    join(folder, "clang-tidy"),
    `#!/bin/sh
for file; do :; done
echo "3 warnings generated." >&2
case "$file" in
  bad.cpp) echo "bad.cpp:1:2: error: use of a moved object [bugprone-use-after-move]"; exit 1 ;;
  broken.cpp) echo "no compile command" >&2; exit 1 ;;
esac
`,
  );
  chmodSync(join(folder, "clang-tidy"), 0o755);
  const tidy = (...files) =>
    spawnSync("python3", [join(repository, "tests/tools/tidy.py"), "build/tidy", report, ...files], {
      encoding: "utf8",
      env: { ...process.env, PATH: `${folder}:${process.env.PATH}` },
    });

  it("passes when there is no finding, with a test per file", () => {
    const run = tidy("a.cpp", "b.cpp");
    assert.equal(run.status, 0, run.stderr);
    assert.equal(run.stdout, "2 files, 0 with findings\n");
    assert.equal(readFileSync(report, "utf8").match(/<testcase /g).length, 2);
  });

  it("fails with the findings, and when clang-tidy itself fails", () => {
    const run = tidy("a.cpp", "bad.cpp", "broken.cpp");
    assert.equal(run.status, 1);
    assert.match(run.stdout, /bad\.cpp:1:2: error: use of a moved object/);
    assert.match(run.stdout, /no compile command/);
    assert.match(run.stdout, /3 files, 2 with findings\n$/);
    assert.equal(readFileSync(report, "utf8").match(/<failure /g).length, 2);
  });
});

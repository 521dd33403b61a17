// The programs that `./dev test -R REGEX` builds.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, it } from "node:test";

import { repository } from "./workshop.mjs";

const targets = (...args) => {
  const run = spawnSync("python3", [join(repository, "tests/tools/test_targets.py"), ...args], { encoding: "utf8" });
  return { code: run.status, names: run.stdout.split("\n").filter(Boolean), complaint: run.stderr };
};

describe("test_targets.py", () => {
  let folder;
  before(() => {
    folder = mkdtempSync(join(tmpdir(), "spindrift targets "));
    mkdirSync(join(folder, "unit"));
    writeFileSync(
      join(folder, "unit/CMakeLists.txt"),
      "spindrift_test(NAME one_test LABEL unit\n  SOURCES a_test.cpp ${CMAKE_SOURCE_DIR}/other.cpp\n  LIBRARIES x)\n" +
        "spindrift_test(NAME two_test LABEL gpu SOURCES b_test.cpp)\n",
    );
    writeFileSync(join(folder, "unit/a_test.cpp"), "TEST(Queue, KeepsItsOrder) {}\n");
    writeFileSync(join(folder, "unit/b_test.cpp"), "TEST_F(Queue,\n       IsBounded) {}\nTEST_P(Sweep, Holds) {}\n");
  });
  after(() => rmSync(folder, { recursive: true }));

  it("names every program with a matching test", () => {
    assert.deepEqual(targets("Queue", folder).names, ["one_test", "two_test"]);
    assert.deepEqual(targets("IsBounded", folder).names, ["two_test"]);
    assert.deepEqual(targets("^gpu/Sweep", folder).names, ["two_test"]);
  });

  it("fails without a matching test, and reports an invalid regular expression", () => {
    assert.deepEqual(targets("nothere", folder), { code: 1, names: [], complaint: "" });
    const wrong = targets("(", folder);
    assert.equal(wrong.code, 2);
    assert.match(wrong.complaint, /no regular expression/);
  });

  it("reads this repository", () => assert.deepEqual(targets("unit/OutboxTest\\.").names, ["net_test"]));
});

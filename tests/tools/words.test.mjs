// words.py, which `./dev lint words` runs.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { afterEach, beforeEach, describe, it } from "node:test";

import { repository } from "./workshop.mjs";

describe("words.py", () => {
  let folder;
  const write = (path, text) => {
    mkdirSync(dirname(join(folder, path)), { recursive: true });
    writeFileSync(join(folder, path), text);
  };
  const check = () => {
    const { status, stdout, stderr } = spawnSync("python3", [join(repository, "tests/tools/words.py"), folder], { encoding: "utf8" });
    assert.equal(stderr, "");
    return { status, faults: stdout.split("\n").filter((line) => line !== "") };
  };
  beforeEach(() => {
    folder = mkdtempSync(join(tmpdir(), "spindrift words "));
    assert.equal(spawnSync("git", ["init", "--quiet", folder]).status, 0);
  });
  afterEach(() => rmSync(folder, { recursive: true }));

  it("names file, line, words and what to write instead", () => {
    write("server/a.cpp", 'int a;\nfail("\'x\' is no number");\n// The room goes on.\n');
    assert.deepEqual(check(), {
      status: 1,
      faults: [
        "server/a.cpp:2: 'is no number': write 'is not a ...', or 'is invalid'",
        "server/a.cpp:3: 'goes on': write 'continue', 'resume'",
      ],
    });
  });

  it("finds rates without 'per', places and comments that begin with a riddle", () => {
    write("server/sim/include/spindrift/sim/a.h", "/// Whether it moves, at a place.\nbool a();\n/// Returns the steps a tick.\n/// Of the last one.\nint b();\n");
    write("server/sim/a.h", "/// Whether it moves. Takes place in the first place.\nbool a();\n");
    assert.deepEqual(check(), {
      status: 1,
      faults: [
        "server/sim/a.h:1: 'Whether' begins a comment: write 'Returns ...', or what the thing is",
        "server/sim/include/spindrift/sim/a.h:1: 'at a place': write 'position'",
        "server/sim/include/spindrift/sim/a.h:1: 'Whether' begins a comment: write 'Returns ...', or what the thing is",
        "server/sim/include/spindrift/sim/a.h:3: 'steps a tick': write 'per'",
      ],
    });
  });

  it("finds prose beyond 140 columns, but neither tables, code nor links", () => {
    const long = "word ".repeat(30);
    write("a.md", `${long}\n\n| ${long} |\n\n    ${long}\n\n\`\`\`\n${long}\n\`\`\`\n\n[text](${"x".repeat(150)})\n`);
    assert.deepEqual(check().faults, ["a.md:1: 150 columns of prose: wrap at 140"]);
  });

  it("accepts the right words, and leaves records as they are", () => {
    write("a.md", "There is no room named quay. It is not a number. The room continues.\n");
    write("CHANGELOG.md", "A restart goes on bit for bit.\n");
    assert.deepEqual(check(), { status: 0, faults: [] });
  });
});

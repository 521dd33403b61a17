// One test for each check of `./dev lint`, over this repository.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { describe, it } from "node:test";

import { repository } from "./workshop.mjs";

describe("./dev lint", () => {
  for (const part of ["format", "shell", "web", "words"]) {
    it(`finds nothing in ${part}`, { timeout: 600_000 }, () => {
      const run = spawnSync("./dev", ["lint", part], { cwd: repository, encoding: "utf8" });
      assert.equal(run.status, 0, run.stdout + run.stderr);
    });
  }

  it("refuses unknown parts", () => {
    const run = spawnSync("./dev", ["lint", "grammar"], { cwd: repository, encoding: "utf8" });
    assert.equal(run.status, 2);
    assert.match(run.stderr, /lint does not know 'grammar'/);
  });
});

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { it } from "node:test";

import { repository } from "./workshop.mjs";

const script = join(repository, "tests/study/write_tables.py");
const written = ["docs/plots/trade.json", "docs/study.md", "docs/accuracy.md", "server/scenes/fidelity_errors.txtpb"];

function run(...args) {
  const result = spawnSync("python3", [script, ...args], { encoding: "utf8" });
  assert.equal(result.stderr, "");
  return { code: result.status, out: result.stdout };
}

it("the documents and the server have the figures of trade.json", () => {
  assert.deepEqual(run("--check"), { code: 0, out: "" });
});

it("write_tables.py names every file that differs, and writes it", () => {
  const root = mkdtempSync(join(tmpdir(), "spindrift tables "));
  try {
    for (const name of written) cpSync(join(repository, name), join(root, name), { recursive: true });
    const figures = join(root, written[0]);
    writeFileSync(figures, readFileSync(figures, "utf8").replace(/"date": "[^"]*"/, '"date": "2001-02-03"'));
    const { code, out } = run("--root", root, "--check");
    assert.equal(code, 1);
    assert.deepEqual(out.trimEnd().split("\n").map((line) => line.split(":")[0]).sort(), written.slice(1).sort());
    assert.equal(run("--root", root).code, 0);
    assert.deepEqual(run("--root", root, "--check"), { code: 0, out: "" });
    for (const name of written) assert.match(readFileSync(join(root, name), "utf8"), /2001-02-03/);
  } finally {
    rmSync(root, { recursive: true });
  }
});

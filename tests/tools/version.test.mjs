// One file holds the version; everything else follows from it.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { describe, it } from "node:test";

import { repository } from "./workshop.mjs";

const text = (file) => readFileSync(join(repository, file), "utf8");
const version = /^project\(spindrift VERSION (\d+\.\d+\.\d+) /m.exec(text("CMakeLists.txt"))?.[1];

describe("the version", () => {
  it("is printed by the program and part of the bundle's name", () => {
    const printed = spawnSync(process.env.SPINDRIFT_BINARY, ["--version"], { encoding: "utf8" });
    assert.equal(printed.status, 0, printed.stderr);
    assert.equal(printed.stdout, `spindrift ${version}\n`);
    const bundle = spawnSync("bash", ["-c", "source .ci/lib/common.sh && project_version"], { cwd: repository, encoding: "utf8" });
    assert.equal(bundle.stdout, `${version}\n`);
  });

  it("is the newest release of the changelog, whose releases are dated and in order", () => {
    const releases = [...text("CHANGELOG.md").matchAll(/^## \[(.+?)\](?: - (.+))?$/gm)].map((match) => ({ name: match[1], date: match[2] }));
    assert.equal(releases.shift().name, "Unreleased");
    assert.equal(releases[0].name, version);
    for (const { name, date } of releases) assert.match(date ?? "", /^\d{4}-\d{2}-\d{2}$/, name);
    const dates = releases.map(({ date }) => date);
    assert.deepEqual(dates, [...dates].sort().reverse());
  });

  it("is in CMakeLists.txt, the changelog and the release recipe only", () => {
    const escaped = version.replaceAll(".", "\\.");
    const command = ["-c", "safe.directory=*", "grep", "-lE", `(^|[^0-9.])${escaped}($|[^0-9.])`, "--", ":!*package-lock.json"];
    const found = spawnSync("git", command, { cwd: repository, encoding: "utf8" });
    const files = found.stdout.split("\n").filter((file) => file !== "" && file !== "docs/release.md");
    assert.deepEqual(files, ["CHANGELOG.md", "CMakeLists.txt"]);
  });
});

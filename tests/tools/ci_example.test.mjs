// docs/examples/ci as it stands: the shell script against the real program, and the workflow that runs it.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, it } from "node:test";

import { repository } from "./workshop.mjs";

const SPINDRIFT = process.env.SPINDRIFT_BINARY ?? join(repository, "build/release/bin/spindrift");
const EXAMPLE = join(repository, "docs/examples/ci");
const PATIENCE_MS = 300_000;

const SCENE = `
  wave { resolution_count: 32 side_m: 8 depth_m: 1 }
  storm { level_ratio: 1 drops_per_m2_s: 2 }
`;
const GOOD = `
  hold_clock: true
  steps { at_s: 0.2 command { command { splash { depth_m: 0.3 radius_m: 1 } } } }
  steps { at_s: 1 hash {} }
`;
const BAD = `
  hold_clock: true
  steps { at_s: 0.1 surface { x_m: 0 z_m: 0 min_m: 0.9 } note: "never <so> high & mighty" }
  steps { wait {} }
`;

function freePort() {
  return new Promise((resolve) => {
    const server = createServer().listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });
}

describe("the example for continuous integration", () => {
  const folder = mkdtempSync(join(tmpdir(), "ci-example-"));
  before(() => {
    for (const [name, text] of Object.entries({ scene: SCENE, good: GOOD, bad: BAD }))
      writeFileSync(join(folder, `${name}.textproto`), text);
  });
  after(() => rmSync(folder, { recursive: true }));

  /** Runs the example with these scripts; returns its exit code, its output, and a reader of its reports. */
  async function run(reports, scripts, scene = join(folder, "scene.textproto")) {
    const port = await freePort();
    const child = spawn(
      join(EXAMPLE, "run-water-tests"),
      [scene, join(folder, reports), ...scripts.map((name) => join(folder, `${name}.textproto`))],
      { env: { ...process.env, SPINDRIFT, PORT: String(port), SEED: "7" }, timeout: PATIENCE_MS },
    );
    let output = "";
    child.stdout.on("data", (data) => (output += data));
    child.stderr.on("data", (data) => (output += data));
    const code = await new Promise((resolve) => child.on("close", resolve));
    return { code, output, read: (name) => readFileSync(join(folder, reports, name), "utf8") };
  }

  it("ends with 0 and the same hash twice where all steps hold", { timeout: PATIENCE_MS }, async () => {
    const { code, output, read } = await run("held", ["good"]);
    assert.equal(code, 0, output);
    assert.match(output, /60 ticks, 1\.000 s, seed 7: state hash 0x[0-9a-f]{16}/);
    assert.match(read("good.xml"), /<testsuite name="good" tests="2" failures="0" errors="0" skipped="0"/);
    const hash = JSON.parse(read("good.json")).state_hash;
    assert.match(hash, /^0x[0-9a-f]{16}$/);
    assert.equal(JSON.parse(read("good-again.json")).state_hash, hash);
    assert.ok(read("good.xml").includes(`<property name="state_hash" value="${hash}"/>`));
  });

  it("ends with 1 and a report where a step fails", { timeout: PATIENCE_MS }, async () => {
    const { code, output, read } = await run("failed", ["bad", "good"]);
    assert.equal(code, 1, output);
    assert.match(read("bad.xml"), /tests="2" failures="1" errors="0" skipped="1"/);
    assert.match(read("bad.xml"), /never &lt;so&gt; high &amp; mighty/);
    assert.match(read("good.xml"), /failures="0"/, "the other script ran, too");
  });

  it("ends with 2 and the reason where the server does not start", { timeout: PATIENCE_MS }, async () => {
    const { code, output } = await run("none", ["good"], join(folder, "no-such-scene.textproto"));
    assert.equal(code, 2);
    assert.match(output, /no-such-scene/);
  });

  it("has a workflow that calls the script and installs what the container image does", () => {
    const workflow = readFileSync(join(EXAMPLE, "water-tests.yml"), "utf8");
    assert.match(workflow, /run: sh water-tests\/run-water-tests harbor reports water-tests\/\*\.textproto/);
    const packages = /apt-get install --yes --quiet --no-install-recommends (.*)/.exec(
      readFileSync(join(repository, "docker/install-runtime"), "utf8"),
    )[1];
    for (const name of packages.split(" ")) assert.ok(workflow.includes(name), `the workflow installs ${name}`);
    assert.doesNotMatch(workflow, /\t/, "YAML has no tabs");
  });
});

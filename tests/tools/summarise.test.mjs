import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { afterEach, beforeEach, describe, it } from "node:test";

import { repository } from "./workshop.mjs";

const CTEST = `<testsuite name="(empty)" tests="5">
  <testcase name="unit/Outbox" classname="unit/Outbox" status="fail"><failure message=""/><system-out>[==========] Running 2 tests from 1 test suite.
[ RUN      ] Outbox.Keeps
[       OK ] Outbox.Keeps (0 ms)
[ RUN      ] Outbox.Drops
expected 1, got 2
[  FAILED  ] Outbox.Drops (3 ms)
[==========] 2 tests from 1 test suite ran. (3 ms total)
[  FAILED  ] 1 test, listed below:
[  FAILED  ] Outbox.Drops</system-out></testcase>
  <testcase name="gpu/Waves/Wave.Travels/Long" classname="gpu/Waves/Wave.Travels/Long" status="run"><system-out>[==========] Running 1 test from 1 test suite.
[ RUN      ] Waves/Wave.Travels/Long
a.cpp:3: Skipped
no EGL device
[  SKIPPED ] Waves/Wave.Travels/Long (0 ms)</system-out></testcase>
  <testcase name="net_test_NOT_BUILT" classname="net_test_NOT_BUILT" status="notrun"><skipped message="Unable to find executable"/></testcase>
  <testcase name="unit/Old" classname="unit/Old" status="disabled"/>
</testsuite>`;
const CRASH = `<testsuite><testcase name="unit/Ring" status="fail"><failure message="SEGFAULT"/><system-out>[==========] Running 3 tests from 1 test suite.
[ RUN      ] Ring.Turns
[       OK ] Ring.Turns (0 ms)
[ RUN      ] Ring.Breaks
</system-out></testcase></testsuite>`;
const NODE = `<testsuites><testsuite name="page"><testcase name="opens" classname="test"/><testcase name="clicks" classname="test"><skipped type="skipped" message="Chromium is missing"/></testcase></testsuite></testsuites>`;

describe("the total of ./dev test", () => {
  let folder;
  beforeEach(() => {
    folder = mkdtempSync(join(tmpdir(), "spindrift sum "));
  });
  afterEach(() => rmSync(folder, { recursive: true }));

  /** Summarises parts, each given as [name, exit code, report or undefined]. */
  function summarise(...parts) {
    const args = parts.map(([name, code, report]) => {
      const path = join(folder, `${name}.xml`);
      if (report !== undefined) writeFileSync(path, report);
      return `${name}:${code}:${path}`;
    });
    const result = spawnSync("python3", [join(repository, "tests/tools/summarise.py"), ...args], { encoding: "utf8" });
    return { code: result.status, text: result.stdout, last: result.stdout.trimEnd().split("\n").at(-1) };
  }

  it("adds the parts up in the last line and fails when one test failed", () => {
    const sum = summarise(["native", 8, CTEST], ["browser", 0, NODE]);
    assert.equal(sum.last, "2 passed, 2 failed, 3 skipped");
    assert.equal(sum.code, 1);
    assert.match(sum.text, /FAILED native: unit\/Outbox\.Drops\n(.*\n)? {4}expected 1, got 2/);
  });

  it("names the test of a suite that crashed, and says how many did not run", () => {
    const sum = summarise(["native", 8, CRASH]);
    assert.equal(sum.last, "1 passed, 2 failed, 0 skipped");
    assert.match(sum.text, /FAILED native: unit\/Ring\.Breaks\n {4}did not end/);
    assert.match(sum.text, /FAILED native: unit\/\n {4}1 tests did not run/);
  });

  it("counts self-skipped tests as skipped and missing programs as failed", () => {
    const { text } = summarise(["native", 8, CTEST]);
    assert.match(text, /skipped native: gpu\/Waves\/Wave\.Travels\/Long \(no EGL device\)/);
    assert.match(text, /FAILED native: net_test_NOT_BUILT\n {4}did not run: Unable to find executable/);
  });

  it("succeeds when nothing failed", () => {
    const sum = summarise(["browser", 0, NODE]);
    assert.equal(sum.last, "1 passed, 0 failed, 1 skipped");
    assert.equal(sum.code, 0);
    assert.match(sum.text, /skipped browser: clicks \(Chromium is missing\)/);
  });

  it("counts a part without a report, with a broken one or without a test as failed", () => {
    for (const report of [undefined, "<testsuite><testcase", "<testsuite/>"]) {
      const sum = summarise(["browser", 0, NODE], ["web", 0, report]);
      assert.equal(sum.last, "1 passed, 1 failed, 1 skipped", String(report));
      assert.equal(sum.code, 1);
    }
  });

  it("counts a part as failed if it exits with an error although every test passed", () => {
    const sum = summarise(["web", 124, NODE]);
    assert.equal(sum.last, "1 passed, 1 failed, 1 skipped");
    assert.match(sum.text, /ended with exit code 124/);
  });
});

// The parts of tests/bench/soak that do not need a cluster.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { join } from "node:path";
import { describe, it } from "node:test";

import { repository } from "./workshop.mjs";

const SOAK = join(repository, "tests/bench/soak");

/** Runs Python in the folder of the soak; returns what it prints, as JSON. */
function python(code) {
  const { status, stdout, stderr } = spawnSync("python3", ["-c", `import json\n${code}`], { encoding: "utf8", cwd: SOAK });
  assert.equal(status, 0, stderr);
  return JSON.parse(stdout);
}

/** Judges samples that are all the same but for `row` (code with k, the number of the sample) and `load`. */
function judge({ row = "{}", load = "{}", count = 60 } = {}) {
  return python(`
from types import SimpleNamespace
import math
from verdict import judge
def sample(k):
    out = {"time_s": 10.0 * k, "calm": 1, "real_time_factor": 1.0}
    for name in ("server", "edge", "nats"):
        out |= {f"{name}_{kind}": 100.0 for kind in ("rss_mb", "pss_mb", "anonymous_mb")}
        out |= {f"{name}_descriptors": 40, f"{name}_connections": 20, f"{name}_threads": 9}
    return out | ${row}
load = {"answer_p50_ms": 5.0, "answer_p99_ms": 20.0, "answers": 9, "heavy_answer_p99_ms": 30.0, "heavy_answers": 3, "unanswered": 0,
        "undecodable": 0, "nonfinite": 0, "watchdog_nonfinite": 0, "rejected": {}, "reconnects": 1, "resumed": 1, "ended": {}, "refused": 0,
        "frames": 7, "decoded": 7} | ${load}
ticks = [{0.008: 0.0, 0.016: 600.0, math.inf: 600.0}] * ${count}
arguments = SimpleNamespace(memory_mb_per_h=1.0, ack_budget_ms=None)
print(json.dumps(judge([sample(k) for k in range(${count})], ticks, load, arguments, 60.0).missed))`);
}

describe("the soak", () => {
  it("fits the slope of a line with outliers, and gives an interval that has it", () => {
    const [value, low, high, least] = python(`
import random
from theil_sen import theil_sen
chance = random.Random(1)
points = [(k / 360, 100 + 0.5 * k / 360 + chance.gauss(0, 0.2) + (50 if k % 10 == 0 else 0)) for k in range(300)]
slope = theil_sen(points)
print(json.dumps([slope.value, slope.low, slope.high, theil_sen([(0, 1), (2, 2)]).value]))`);
    assert.ok(low < 0.5 && 0.5 < high, `${low} to ${high}`);
    assert.ok(Math.abs(value - 0.5) < 0.3, `${value}`);
    assert.equal(least, 0.5);
  });

  it("refuses a slope through points at one place", () => {
    const text = python(`
from theil_sen import theil_sen
try:
    theil_sen([(1, 2), (1, 3)])
except ValueError as error:
    print(json.dumps(str(error)))`);
    assert.match(text, /two different x, there are 2 points/);
  });

  it("takes quantiles of a histogram between two moments, so that the time before does not count", () => {
    const found = python(`
import math, histogram
page = {'x_bucket{room="main",le="0.01"}': 10, 'x_bucket{room="main",le="0.02"}': 20, 'x_bucket{room="main",le="+Inf"}': 20,
        'x_bucket{room="tank",le="+Inf"}': 999}
later = {0.01: 60.0, 0.02: 120.0, math.inf: 120.0}
passed = histogram.difference(later, histogram.buckets_of(page, "x", 'room="main"'))
restarted = histogram.difference({0.01: 5.0, 0.02: 5.0, math.inf: 5.0}, later)
print(json.dumps([passed[0.01], passed[math.inf], histogram.quantile(passed, 0.5), histogram.quantile(passed, 0.75), restarted[math.inf],
                  histogram.total([passed, restarted])[math.inf], histogram.quantile({0.01: 0.0, math.inf: 3.0}, 0.5)]))`);
    assert.deepEqual(found, [50, 100, 0.01, 0.015, 5, 105, 0.01]);
  });

  it("reads memory from smaps_rollup, and says which field is missing", () => {
    const [found, fault] = python(`
from process_samples import read_memory
text = "5600-7fff ---p 00000000 00:00 0    [rollup]\\nRss:      1000 kB\\nPss:       500 kB\\nPss_Anon:  400 kB\\nAnonymous: 250 kB\\n"
try:
    read_memory("Rss: 1 kB\\nPss: 1 kB\\n")
except ValueError as error:
    print(json.dumps([read_memory(text), str(error)]))`);
    assert.deepEqual(found, { rss_mb: 1.024, pss_mb: 0.512, anonymous_mb: 0.256 });
    assert.match(fault, /no anonymous_mb/);
  });

  it("reads the newest whole row of the load, and no row of its table", () => {
    const found = python(`
from load_rows import newest_row
head = "  time_s  open  p99_ms\\n"
print(json.dumps([newest_row(""), newest_row(head), newest_row("warning\\n" + head + " 10.0 40 5.5\\n 20.0 41 6.5\\n 30.0 42"),
                  newest_row(head + " 10.0 40 5.5\\nclients 40\\nended {} x\\n")]))`);
    assert.deepEqual(found, [{}, {}, { time_s: 20, open: 41, p99_ms: 6.5 }, { time_s: 10, open: 40, p99_ms: 5.5 }]);
  });

  it("finds nothing wrong with processes that stay as they are", () => {
    assert.deepEqual(judge(), []);
  });

  it("misses the bound of memory with a slow leak, and names value and bound", () => {
    // 2 MB per hour.
    const missed = judge({ row: '{"edge_rss_mb": 100.0 + 2.0 * k * 10.0 / 3600.0}' });
    assert.equal(missed.length, 1);
    assert.match(missed[0], /^memory of edge: 2 MB\/h.*\(bound 1 MB\/h\)$/);
  });

  it("ignores memory of additional rooms and of NATS", () => {
    assert.deepEqual(judge({ row: '{"calm": int(k < 40), "server_rss_mb": 100.0 if k < 40 else 200.0, "nats_rss_mb": 100.0 + k}' }), []);
  });

  it("misses the bound of descriptors that are not those of clients", () => {
    const missed = judge({ row: '{"server_descriptors": 40 + k // 20, "edge_descriptors": 40 + k, "edge_connections": 20 + k}' });
    assert.equal(missed.length, 1);
    assert.match(missed[0], /^descriptors of server without clients, growth: 2 .*20 to 22/);
  });

  it("misses the bounds of ticks, answers and numbers", () => {
    const missed = judge({ load: '{"answer_p99_ms": 70.0, "unanswered": 1, "nonfinite": 2}' });
    assert.deepEqual(missed.map((line) => line.split(":")[0]), ["ack p99", "unanswered", "nonfinite"]);
    assert.match(missed[0], /bound 66\.6667 ms/);
  });

  it("does not judge by too few samples", () => {
    assert.deepEqual(judge({ count: 2 }), ["2 samples to judge by, 3 are needed: run longer"]);
  });

  it("refuses a run that is all warm-up", () => {
    const { status, stderr } = spawnSync("python3", [join(SOAK, "soak.py"), "--program", "x", "--minutes", "10"], { encoding: "utf8" });
    assert.equal(status, 2);
    assert.match(stderr, /--minutes 10 must be more than --warm-up-minutes 10/);
  });
});

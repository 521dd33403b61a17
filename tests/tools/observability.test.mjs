// docker/observability: every metric, type and label that rules and dashboard name is one that the server has.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { once } from "node:events";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { after, before, describe, it } from "node:test";

import { readMetrics } from "./metrics_source.mjs";
import { faultsOf, metricNamed, selectorsOf } from "./promql.mjs";
import { repository } from "./workshop.mjs";

const { parse } = createRequire(join(repository, "tests/containers/package.json"))("yaml");

/** Metrics that need no chart, each with the reason. */
const NOT_ON_THE_DASHBOARD = new Map([]);

const textOf = (path) => readFileSync(join(repository, path), "utf8");
const metrics = readMetrics();
const rules = parse(textOf("docker/observability/prometheus-rules.yml")).groups.flatMap((group) => group.rules);
const dashboard = JSON.parse(textOf("docker/observability/grafana-dashboard.json"));
const charts = dashboard.panels.filter((panel) => panel.type !== "row");
const targets = charts.flatMap((panel) => panel.targets.map((target) => ({ ...target, panel: panel.title })));

describe("the alerts", () => {
  it("use metrics, types and labels that the server has", () => {
    for (const { alert, expr, annotations } of rules) {
      assert.deepEqual(faultsOf(expr, metrics, [annotations.summary]), [], alert);
    }
  });

  it("have unlike names, a severity, a time, a summary, and a runbook whose section exists", () => {
    assert.equal(new Set(rules.map((rule) => rule.alert)).size, rules.length);
    for (const rule of rules) {
      assert.match(rule.alert, /^Spindrift[A-Z][A-Za-z]+$/);
      assert.match(rule.labels.severity, /^(critical|warning|info)$/, rule.alert);
      assert.match(rule.for, /^\d+m$/, rule.alert);
      assert.ok(rule.annotations.summary.includes("{{ $labels.instance }}"), rule.alert);
      const [path, anchor] = rule.annotations.runbook.split("#");
      const anchors = [...textOf(path).matchAll(/^#+ (.+)$/gm)].map((match) => match[1].toLowerCase().replace(/[^\w\- ]/g, "").replaceAll(" ", "-"));
      assert.ok(anchors.includes(anchor), `${rule.alert}: ${path} has no heading #${anchor}`);
    }
  });

  it("are those of the table in docs/operations/watch.md, with their severities", () => {
    const rows = [...textOf("docs/operations/watch.md").matchAll(/^\| `(Spindrift\w+)` \| (\w+) \|/gm)].map((match) => [match[1], match[2]]);
    assert.deepEqual(Object.fromEntries(rows), Object.fromEntries(rules.map((rule) => [rule.alert, rule.labels.severity])));
  });

  it("are valid for promtool, and fire when they should", (context) => {
    const tool = (args) => spawnSync("promtool", args, { cwd: repository, encoding: "utf8" });
    if (tool(["--version"]).error) return context.skip("promtool is not installed (Debian: prometheus)");
    for (const args of [
      ["check", "rules", "docker/observability/prometheus-rules.yml"],
      ["check", "config", "docker/observability/prometheus.yml"],
      ["test", "rules", "tests/tools/alerts.promtool.yml"],
    ]) {
      const result = tool(args);
      assert.equal(result.status, 0, `${args.join(" ")}: ${result.stdout}${result.stderr}`);
    }
  });
});

describe("the example of a Prometheus", () => {
  it("reads the rules that are beside it, under the job that they name", () => {
    const config = parse(textOf("docker/observability/prometheus.yml"));
    assert.deepEqual(config.rule_files, ["prometheus-rules.yml"]);
    assert.deepEqual(config.scrape_configs.map((job) => [job.job_name, job.metrics_path]), [["spindrift", "/metrics"]]);
    for (const [, job] of JSON.stringify([rules, dashboard]).matchAll(/job=\\+"(\w+)/g)) assert.equal(job, "spindrift");
  });
});

describe("the dashboard", () => {
  it("uses metrics, types and labels that the server has", () => {
    for (const { panel, expr, legendFormat } of targets) assert.deepEqual(faultsOf(expr, metrics, [legendFormat ?? ""]), [], panel);
    for (const { query } of dashboard.templating.list.filter((variable) => variable.type === "query")) {
      const [, metric, label] = query.match(/^label_values\(spindrift_(\w+)(?:\{[^}]*\})?, (\w+)\)$/);
      assert.ok(metrics.has(metric), query);
      assert.ok(["instance", ...metrics.get(metric).labels].includes(label), query);
    }
  });

  it("shows every metric of the server, but for those that are listed here with a reason", () => {
    const shown = new Set(targets.flatMap(({ expr }) => selectorsOf(expr).flatMap(({ name }) => [name, name.replace(/_(bucket|sum|count)$/, "")])));
    const missing = [...metrics.keys()].filter((name) => !shown.has(name) && !NOT_ON_THE_DASHBOARD.has(name));
    assert.deepEqual(missing, [], "add a chart to docker/observability/grafana-dashboard.json, or a reason to NOT_ON_THE_DASHBOARD");
    assert.deepEqual([...NOT_ON_THE_DASHBOARD.keys()].filter((name) => shown.has(name) || !metrics.has(name)), []);
  });

  it("follows the choice of server and room in every chart", () => {
    for (const { panel, expr } of targets) {
      for (const selector of selectorsOf(expr)) {
        const chosen = Object.fromEntries(selector.matchers.map(({ label, values }) => [label, values.join("|")]));
        assert.equal(chosen.instance, "$instance", `${panel}: ${selector.name}`);
        assert.equal(chosen.room, metricNamed(metrics, selector.name).labels.includes("room") ? "$room" : undefined, `${panel}: ${selector.name}`);
      }
    }
  });

  it("has charts with own numbers that do not overlap", () => {
    assert.equal(dashboard.uid, "spindrift");
    assert.equal(new Set(dashboard.panels.map((panel) => panel.id)).size, dashboard.panels.length);
    const taken = new Map();
    for (const { title, gridPos } of dashboard.panels) {
      assert.ok(gridPos.x >= 0 && gridPos.x + gridPos.w <= 24, title);
      for (let x = gridPos.x; x < gridPos.x + gridPos.w; ++x) {
        for (let y = gridPos.y; y < gridPos.y + gridPos.h; ++y) {
          assert.ok(!taken.has(`${x} ${y}`), `${title} overlaps ${taken.get(`${x} ${y}`)}`);
          taken.set(`${x} ${y}`, title);
        }
      }
    }
    for (const { title, datasource, fieldConfig, targets: queries } of charts) {
      assert.deepEqual(datasource, { type: "prometheus", uid: "${datasource}" }, title);
      assert.ok(fieldConfig.defaults.unit, title);
      assert.equal(new Set(queries.map((query) => query.refId)).size, queries.length, title);
    }
  });
});

describe("the metrics of a running server", () => {
  let folder;
  let server;
  let reason;
  let page = "";
  const served = new Map(); // name -> { type, labels: Set, values: label -> Set }
  before(async () => {
    folder = mkdtempSync(join(tmpdir(), "spindrift metrics "));
    mkdirSync(join(folder, "state"));
    writeFileSync(join(folder, "pond.textproto"), 'wave { resolution_count: 32 side_m: 8 depth_m: 1 }\ngauges { name: "shore" x_m: 3 z_m: 3 }\n');
    const args = ["serve", "--scene", join(folder, "pond.textproto"), "--device", "software", "--port", "0", "--state-dir", join(folder, "state"), "--audit-log", join(folder, "audit.jsonl")];
    server = spawn(process.env.SPINDRIFT_BINARY, args, { stdio: ["ignore", "pipe", "pipe"] });
    let errors = "";
    server.stderr.on("data", (chunk) => (errors += chunk));
    const ended = once(server, "exit").then(([code]) => ({ code }));
    const ready = once(createInterface({ input: server.stdout }), "line").then(([line]) => ({ line }));
    const { line, code } = await Promise.race([ready, ended]);
    if (code === 3) return (reason = errors);
    assert.ok(line, errors);
    const url = line.match(/http:\S+/)[0];
    // Passes and gauges come with the first ticks.
    for (let k = 0; k < 100 && !(page.includes("pass=") && page.includes("gauge=")); ++k) {
      await new Promise((resolve) => setTimeout(resolve, 100));
      page = await (await fetch(`${url}metrics`)).text();
    }
    for (const [, name, type] of page.matchAll(/^# TYPE spindrift_(\w+) (\w+)$/gm)) served.set(name, { type, labels: {} });
    const whole = (name) => served.get(name) ?? served.get(name.replace(/_(bucket|sum|count)$/, ""));
    for (const [, name, labels] of page.matchAll(/^spindrift_(\w+)\{([^}]*)\} /gm)) {
      for (const [, label, value] of labels.matchAll(/(\w+)="([^"]*)"/g)) (whole(name).labels[label] ??= new Set()).add(value);
    }
  });
  after(async () => {
    if (server?.exitCode === null) {
      server.kill("SIGTERM");
      await once(server, "exit");
    }
    rmSync(folder, { recursive: true });
  });

  it("are those that the tests above read from the source, with the same types and labels", (context) => {
    if (reason) return context.skip(reason);
    assert.deepEqual([...served.keys()].sort(), [...metrics.keys()].sort());
    for (const [name, { type, labels }] of metrics) {
      assert.equal(served.get(name).type, type, name);
      // Nobody has been closed so far, so this one has no sample.
      if (name !== "sessions_closed_total") assert.deepEqual(Object.keys(served.get(name).labels).sort(), [...labels].sort(), name);
    }
  });

  it("count histogram buckets cumulatively", (context) => {
    if (reason) return context.skip(reason);
    for (const [name] of [...metrics].filter(([, { type }]) => type === "histogram")) {
      const rows = [...page.matchAll(new RegExp(`^spindrift_${name}_bucket\\{.*le="([^"]+)"\\} (\\d+)$`, "gm"))];
      const counts = rows.map((row) => Number(row[2]));
      assert.ok(counts.length > 2, name);
      assert.equal(rows.at(-1)[1], "+Inf", name);
      assert.deepEqual(counts, counts.toSorted((a, b) => a - b), name);
      assert.equal(counts.at(-1), Number(page.match(new RegExp(`^spindrift_${name}_count\\{.*\\} (\\d+)$`, "m"))[1]), name);
      assert.ok(counts.at(-1) > 0, name);
    }
  });

  it("have the reasons that the alerts name", (context) => {
    if (reason) return context.skip(reason);
    for (const { alert, expr } of rules) {
      for (const { name, matchers } of selectorsOf(expr)) {
        for (const { label, values } of matchers.filter((matcher) => matcher.label === "reason")) {
          for (const value of values) assert.ok(served.get(name).labels[label].has(value), `${alert}: ${name} has no ${label} "${value}"`);
        }
      }
    }
  });
});

describe("the check of expressions", () => {
  const known = new Map([
    ["ticks_total", { type: "counter", labels: ["room"] }],
    ["speed", { type: "gauge", labels: ["room"] }],
    ["refused_total", { type: "counter", labels: ["reason"] }],
  ]);
  const cases = [
    ["rate(spindrift_ticks_total[5m]) > 0 and spindrift_speed > 0", ["{{room}}"], []],
    ['sum by (instance, reason) (rate(spindrift_refused_total{reason=~"a|b"}[5m]))', ["{{ $labels.reason }}"], []],
    ["rate(spindrift_tick_total[5m])", [], ["the server has no metric spindrift_tick_total"]],
    ["spindrift_ticks_total > 0", [], ["ticks_total is a counter: use rate() or increase()"]],
    ["increase(spindrift_speed[5m])", [], ["speed is a gauge: increase() is for counters"]],
    ['spindrift_speed{rooms="a"}', [], ["speed has no label rooms"]],
    ["sum by (room) (rate(spindrift_refused_total[5m]))", [], ["refused_total has no label room"]],
    ["sum by (instance) (rate(spindrift_ticks_total[5m]))", ["{{room}}"], ['the result has no label room, which "{{room}}" names']],
  ];
  for (const [expr, texts, faults] of cases) {
    it(`${faults.length ? "refuses" : "accepts"} ${expr}${texts.length ? ` with ${texts}` : ""}`, () => assert.deepEqual(faultsOf(expr, known, texts), faults));
  }
});

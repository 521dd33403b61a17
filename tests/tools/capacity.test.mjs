import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, it } from "node:test";

import { repository } from "./workshop.mjs";

const CAPACITY = join(repository, "tests/bench/capacity");

/** Values of a small cluster that is easy to reckon with; the other parameters keep what stands in the file. */
const VALUES = {
  streams: {
    "surface.coarse": { rate_hz: 20, delta_bytes: 5000, keyframe_bytes: 10000, encode_s: 0.0002 },
    "surface.full": { rate_hz: 60, delta_bytes: 10000, keyframe_bytes: 40000, encode_s: 0.0004 },
    "bodies.full": { rate_hz: 60, delta_bytes: 0, keyframe_bytes: 100, encode_s: 0.00001 },
  },
  level_streams: { coarse: ["surface.coarse", "bodies.full"], full: ["surface.full", "bodies.full"] },
  lost_frame_share: 0,
  wire_overhead_share: 0,
  network_latency_s: 0.0003,
  watching_bytes: 60,
  link_pulse_bytes: 40,
  view_bytes: 2000,
  news_bytes_per_s: 60,
  news_messages_per_s: 1,
  arrival_bytes: 100,
  command_bytes: 150,
  server_pulse_bytes: 40,
  greeting_bytes: 5000,
  origin_delay_p50_s: 0.003,
  origin_delay_p99_s: 0.006,
  origin_idle_cpu: 0.5,
  origin_cpu_per_published_frame_s: 0.0001,
  origin_cpu_per_link_s: 0.001,
  edge_idle_cpu: 0.003,
  edge_cpu_per_frame_received_s: 0.00005,
  edge_cpu_per_frame_sent_s: 0.00001,
  edge_cpu_per_byte_sent_s: 1e-10,
  edge_cpu_per_join_s: 0.0005,
  edge_memory_bytes: 20e6,
  edge_memory_per_client_bytes: 10e3,
  nats_idle_cpu: 0.01,
  nats_cpu_per_message_in_s: 0.00001,
  nats_cpu_per_message_out_s: 0.000005,
  nats_cpu_per_byte_out_s: 1e-10,
  nats_cpu_per_directory_check_s: 0.00002,
  nats_cpu_per_directory_write_s: 0.00002,
  nats_cpu_per_directory_change_told_s: 0.00001,
  nats_memory_bytes: 20e6,
  directory_check_s: 0.001,
  directory_write_s: 0.0002,
  bench_cpu_per_frame_s: 0.00001,
  room_thread_share: 0.05,
  room_cpu: 0.1,
  room_memory_bytes: 160e6,
  room_build_p50_s: 1,
  room_build_p99_s: 1.5,
};

describe("the capacity model", () => {
  let folder;
  before(() => {
    folder = mkdtempSync(join(tmpdir(), "spindrift capacity "));
  });
  after(() => rmSync(folder, { recursive: true }));

  /** Runs the model with VALUES and `changes`; returns exit code, error text and result. */
  function run(args, changes = {}) {
    const content = JSON.parse(readFileSync(join(CAPACITY, "capacity_parameters.json"), "utf8"));
    for (const [name, value] of Object.entries({ ...VALUES, ...changes })) content[name].value = value;
    const file = join(folder, "parameters.json");
    writeFileSync(file, JSON.stringify(content));
    const command = [join(CAPACITY, "capacity_model.py"), "--parameters", file, "--json", "-", ...args];
    const { status, stdout, stderr } = spawnSync("python3", command, { encoding: "utf8" });
    return { code: status, text: stderr, result: status === 0 ? JSON.parse(stdout) : undefined };
  }

  /** Runs it and expects a result. */
  function predict(args, changes) {
    const { text, result } = run(args, changes);
    assert.ok(result, text);
    return result;
  }

  /** One room whose clients are all there and stay. */
  function steady(clients, edges, ...args) {
    const fixed = ["--arrivals-per-s", "0", "--churn-per-s", "0", "--seconds", "2", "--levels", "coarse=0.6,full=0.4"];
    return predict(["--case", "fanout", "--clients", String(clients), "--edges", String(edges), ...fixed, ...args]);
  }

  /** Five deaths of a server. */
  function deaths(changes = {}, ...args) {
    return predict(["--case", "failover", "--rooms", "60", "--servers", "6", "--runs", "5", ...args], changes);
  }

  it("sends as many bytes of frames out of NATS as come in, times the edges", () => {
    for (const edges of [1, 4, 10]) {
      const { nats_frame_bytes_in: bytesIn, nats_frame_bytes_out: bytesOut } = steady(400, edges);
      assert.ok(bytesIn > 0);
      assert.equal(bytesOut, bytesIn * edges);
    }
  });

  it("keeps the cost of the room's server the same for any number of clients behind the same edges", () => {
    assert.equal(steady(100, 4).origin_cpu_cores, steady(2000, 4).origin_cpu_cores);
  });

  it("needs more CPU, bandwidth, memory and time of an edge for more clients", () => {
    const [few, more, many] = [50, 200, 800].map((clients) => steady(clients, 2));
    for (const name of ["edge_cpu_cores", "client_mbit_per_s", "edge_memory_mb", "delay_p50_ms", "delay_p99_ms"]) {
      assert.ok(few[name] < more[name] && more[name] < many[name], `${name}: ${few[name]}, ${more[name]}, ${many[name]}`);
    }
  });

  it("sends each client the frames of its level, and their bytes", () => {
    const result = steady(40, 2, "--levels", "coarse=1");
    assert.ok(Math.abs(result.surface_frames_per_client_per_s - 20) < 0.2);
    // The bodies come at the rate of the level.
    const expected = 8e-6 * 40 * (20 * 5000 + 20 * 100);
    assert.ok(Math.abs(result.client_mbit_per_s / expected - 1) < 0.02, `${result.client_mbit_per_s}, not ${expected}`);
  });

  it("makes the frames that a reduced level leaves out only for others who take them", () => {
    const frames = (levels) => steady(40, 1, "--levels", levels).nats_messages_in_per_s;
    const [coarse, full, both] = ["coarse=1", "full=1", "coarse=0.5,full=0.5"].map(frames);
    const near = (value, expected) => assert.ok(Math.abs(value - expected) < 2, `${value}, not ${expected}`);
    near(full - coarse, 60 + 60 - (20 + 20));
    near(both - full, 20);
  });

  it("says that an edge is overloaded when its clients need more than its thread", () => {
    assert.ok(steady(800, 2).edge_backlog_s < 0.05);
    assert.ok(steady(20_000, 2).edge_backlog_s > 0.5);
  });

  it("does not make the clients of one edge wait for those of another", () => {
    // The same edges with the same clients each, alone and among others.
    const [alone, among] = [steady(200, 1), steady(2000, 10)];
    assert.ok(Math.abs(alone.delay_p99_ms - among.delay_p99_ms) < 1.5, `${alone.delay_p99_ms}, ${among.delay_p99_ms}`);
  });

  it("sends keyframes over NATS only while clients come or lose frames", () => {
    assert.equal(steady(400, 4).nats_keyframe_out_mbit_per_s, 0);
    const coming = steady(400, 4, "--churn-per-s", "20");
    assert.ok(coming.nats_keyframe_out_mbit_per_s > 0);
    assert.ok(coming.first_frame_p50_ms > 0);
  });

  it("brings the clients of a dead edge to the others", () => {
    const result = steady(400, 4, "--edge-death");
    assert.ok(result.first_frame_p50_ms > 250, "a client waits before it connects again");
    assert.ok(result.first_frame_p99_ms < 3000);
  });

  it("brings every room of a dead server back", () => {
    const result = deaths();
    assert.equal(result.rooms_not_back, 0);
    // The last pulse is up to 0.2 s old when the server dies.
    assert.ok(result.claim_p50_s >= 1.0 - 0.2);
    assert.ok(result.failover_fastest_s >= 1.0 - 0.2 + 0.5);
    assert.ok(result.failover_p50_s <= result.failover_p90_s && result.failover_p90_s <= result.failover_max_s);
  });

  it("takes longer where a room takes longer to build, and where one server takes several", () => {
    assert.ok(deaths({ room_build_p50_s: 3, room_build_p99_s: 4 }).failover_p50_s > deaths().failover_p50_s);
    const spread = deaths({}, "--servers", "20");
    const crowded = deaths({}, "--servers", "2", "--room-max-count", "64");
    assert.ok(crowded.failover_max_s > spread.failover_max_s);
  });

  it("names the rooms that a server keeps in real time, and what it loses with more", () => {
    const light = deaths();
    assert.equal(light.rooms_per_server_in_real_time, 20);
    assert.equal(light.real_time_factor_before, 1);
    assert.equal(deaths({ room_thread_share: 0.5 }).real_time_factor_before, 0.2);
  });

  it("gives the same result for the same seed, and another for another", () => {
    const withSeed = (seed) => steady(300, 3, "--churn-per-s", "20", "--seed", seed);
    assert.deepEqual(withSeed("7"), withSeed("7"));
    assert.notDeepEqual(withSeed("7"), withSeed("8"));
    assert.deepEqual(deaths({}, "--seed", "7"), deaths({}, "--seed", "7"));
  });

  it("refuses to run without a measurement, and names it", () => {
    const { code, text } = run(["--case", "failover"], { room_build_p50_s: null });
    assert.equal(code, 1);
    assert.match(text, /1 parameters were not measured \(room_build_p50_s\): run capacity_measure\.py/);
  });

  it("refuses rooms that do not fit and shares that are not the whole", () => {
    assert.match(run(["--case", "failover", "--rooms", "100", "--servers", "2"]).text, /100 rooms do not fit on 2 servers/);
    assert.match(run(["--case", "fanout", "--levels", "coarse=0.5"]).text, /add up to 0\.5, not 1/);
  });

  it("knows unit, meaning and source of every parameter", () => {
    const content = JSON.parse(readFileSync(join(CAPACITY, "capacity_parameters.json"), "utf8"));
    for (const [name, entry] of Object.entries(content)) {
      assert.deepEqual(Object.keys(entry).sort(), ["meaning", "source", "unit", "value"], name);
      for (const [, file, constant] of entry.source.matchAll(/(server\/[\w/]+\.(?:h|cpp)): (k\w+)/g)) {
        assert.match(readFileSync(join(repository, file), "utf8"), new RegExp(`\\b${constant}\\b`), name);
      }
    }
  });

  it("waits as long as the load bench does before it measures", () => {
    const bench = readFileSync(join(repository, "tests/bench/load.cpp"), "utf8");
    const measurement = readFileSync(join(CAPACITY, "measured_costs.py"), "utf8");
    const number = (text, pattern) => Number(pattern.exec(text)?.[1]);
    assert.equal(number(measurement, /^SETTLE_S = ([\d.]+)/m), number(bench, /kSettle\{(\d+)\}/));
    assert.equal(number(measurement, /^ARRIVALS_PER_S = (\d+)/m), number(bench, /kArrivals_per_s = (\d+)/));
  });

  /** Runs Python in the folder of the model; returns what it prints, as JSON. */
  function python(code) {
    const { status, stdout, stderr } = spawnSync("python3", ["-c", code], { encoding: "utf8", cwd: CAPACITY });
    assert.equal(status, 0, stderr);
    return JSON.parse(stdout);
  }

  it("fits costs to measured rows, none of them negative", () => {
    const [exact, bounded] = python(`
import json
from least_squares import fit
rows = [[1, 0, 0], [1, 90, 4500], [1, 90, 9000], [1, 180, 40000]]
true = [0.003, 0.0001, 0.00001]
exact = fit(rows, [sum(a * b for a, b in zip(row, true)) for row in rows])
print(json.dumps([exact, fit([[1, 0], [1, 1], [1, 2]], [3, 2, 1])]))`);
    for (const [k, value] of [0.003, 0.0001, 0.00001].entries()) assert.ok(Math.abs(exact[k] / value - 1) < 1e-6);
    assert.deepEqual(bounded, [2, 0]);
  });

  it("reads sizes of frames and messages from the bus", () => {
    const found = python(`
import json
from bus_probe import BusProbe
from nats_client import FRAME_HEAD, PART_HEAD, string_field
class Silent:
    def subscribe(self, subject): return 1
probe = BusProbe(Silent(), "spindrift", lambda stream, level: f"{stream}.{level}")
part = PART_HEAD.pack(1, 0, 1)
probe.take(["frames", "main", "7", "coarse", "key"], part + FRAME_HEAD.pack(1, 2, 3, 4, 15, 900, 100))
probe.take(["frames", "main", "7", "coarse"], part + FRAME_HEAD.pack(1, 2, 3, 4, 15, 0, 100))
probe.take(["room", "main"], part + string_field(1, "e1") + string_field(4, ""))
probe.take(["servers"], part + string_field(1, "s1") + bytes([3 << 3 | 1]) + __import__("struct").pack("<d", 0.5))
print(json.dumps([probe.counts, probe.deltas, probe.keyframes, probe.control, probe.loads]))`);
    assert.deepEqual(found, [
      { "7.coarse": 1 },
      { "7.coarse": [100] },
      { "7.coarse": [900] },
      { watching: [22], server_pulse: [29] },
      { s1: [0.5] },
    ]);
  });
});

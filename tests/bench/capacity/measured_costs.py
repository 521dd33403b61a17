"""Costs of frames: runs the load bench in several sizes and fits CPU and memory per edge, client, frame and byte."""
import os
import statistics
import time

from bus_probe import BusProbe, greeting_bytes
from cluster_processes import Cluster, machine_cpu_s
from least_squares import fit
from nats_client import NatsClient

# Clients of the runs that give stream sizes and the delay without load; fanout_model.py takes out their own cost.
PROBE_CLIENTS = 10
ARRIVALS_PER_S = 200  # tests/bench/load.cpp: kArrivals_per_s
SETTLE_S = 5.0  # tests/bench/load.cpp: kSettle
# The threads that simulate; what the other threads of a server do serves watchers.
SIMULATING_THREADS = 3
KINDS = ("deltas", "keyframes")
# v1::Layer; the number of a stream is that of its layer, plus this count if it is packed (server/codec/stream.h).
LAYERS = ("unspecified", "surface", "particles", "bodies", "foam", "diagnostics")
# The fitted parameters, in the order of the columns.
EDGE_COSTS = ("edge_idle_cpu", "edge_cpu_per_frame_received_s", "edge_cpu_per_frame_sent_s", "edge_cpu_per_byte_sent_s")
NATS_COSTS = ("nats_idle_cpu", "nats_cpu_per_message_in_s", "nats_cpu_per_message_out_s", "nats_cpu_per_byte_out_s")


class Snapshot:
    """Everything that counts up, at one moment."""

    def __init__(self, cluster: Cluster, edges: list, load=None):
        self.time_s = time.monotonic()
        server = cluster.servers["s1"]
        self.server_cpu = server.cpu_s()
        self.threads = server.thread_cpu_s()
        self.server = server.metrics()
        self.edge_cpu = [edge.cpu_s() for edge in edges]
        self.edges = [edge.metrics() for edge in edges]
        self.nats_cpu = cluster.nats.cpu_s()
        self.nats = cluster.nats_totals()
        self.load_cpu = load.cpu_s() if load else 0.0
        self.machine_cpu = machine_cpu_s()
        self.own_cpu = os.times().user + os.times().system + self.nats_cpu + self.load_cpu
        self.own_cpu += sum(one.cpu_s() for one in [*cluster.servers.values(), *cluster.edges.values()] if one.child.poll() is None)


class Rates:
    """Per second between two snapshots."""

    def __init__(self, a: Snapshot, b: Snapshot):
        self.a, self.b, self.time_s = a, b, b.time_s - a.time_s
        self.server_cpu = (b.server_cpu - a.server_cpu) / self.time_s
        threads = sorted(b.threads[name] - a.threads.get(name, 0.0) for name in b.threads)
        self.watching_cpu = sum(threads[:-SIMULATING_THREADS]) / self.time_s
        self.nats_cpu = (b.nats_cpu - a.nats_cpu) / self.time_s
        self.load_cpu = (b.load_cpu - a.load_cpu) / self.time_s
        self.other_cpu = max(0.0, b.machine_cpu - a.machine_cpu - (b.own_cpu - a.own_cpu)) / self.time_s
        self.nats = {name: (b.nats[name] - a.nats[name]) / self.time_s for name in b.nats}

    def server(self, name: str) -> float:
        return (self.b.server.get(name, 0.0) - self.a.server.get(name, 0.0)) / self.time_s

    def edge(self, k: int, name: str) -> float:
        return (self.b.edges[k][name] - self.a.edges[k][name]) / self.time_s

    def edge_row(self, k: int) -> list:
        names = ("spindrift_cluster_remote_frames_total", "spindrift_sent_frames_total", "spindrift_sent_bytes_total")
        return [1.0, *(self.edge(k, name) for name in names)]

    def edge_cpu(self, k: int) -> float:
        return (self.b.edge_cpu[k] - self.a.edge_cpu[k]) / self.time_s


def run_load(cluster, edges, clients, level, seconds, commands_per_s=0.0, meanwhile=time.sleep):
    """Returns the bench's result, and the rates while clients come and in the measured time."""
    start = Snapshot(cluster, edges)
    load = cluster.start_load(edges, clients, level, seconds, commands_per_s)
    try:
        time.sleep(clients / ARRIVALS_PER_S + 0.2)
        came = Snapshot(cluster, edges, load)
        meanwhile(SETTLE_S - 0.2)
        begin = Snapshot(cluster, edges, load)
        memory = [edge.memory_bytes() for edge in edges]
        time.sleep(max(0.5, seconds - 0.3))
        end = Snapshot(cluster, edges, load)
        result = cluster.load_result(load)
    finally:
        load.end()
    if result["open"] != clients:
        raise RuntimeError(f"only {result['open']} of {clients} clients stayed connected")
    return result, Rates(start, came), Rates(begin, end), memory


def measure_streams(cluster: Cluster, edges: list, seconds: float) -> dict:
    """Sizes and rates of the streams of each level, control messages, and the delay without load."""
    found = {"streams": {}, "level_streams": {}}
    client = NatsClient(cluster.url)
    control, delays = {}, []
    for level in ("coarse", "medium", "full"):
        probe = BusProbe(client, "spindrift", lambda stream, of: f"{LAYERS[stream % len(LAYERS)]}.{of}")
        # Listens from the first client on: those who come need keyframes.
        commands = 2.0 if level == "coarse" else 0.0
        load = cluster.start_load(edges[:1], PROBE_CLIENTS, level, seconds, commands)
        try:
            probe.listen(PROBE_CLIENTS / ARRIVALS_PER_S + SETTLE_S)
            before = probe.counts.copy()
            metrics, begin = cluster.servers["s1"].metrics(), time.monotonic()
            probe.listen(seconds)
            time_s, after = time.monotonic() - begin, cluster.servers["s1"].metrics()
            result = cluster.load_result(load)
        finally:
            load.end()
        probe.end()
        found["level_streams"][level] = []
        for name, count in probe.counts.items():
            if name.split(".")[0] == "diagnostics":
                continue
            layer, of = name.split(".")
            encoded, encode_s = (
                sum(after.get(key, 0.0) - metrics.get(key, 0.0) for key in
                    (f'spindrift_{total}{{layer="{layer}",packing="{packing}",level="{of}"}}' for packing in ("packed", "plain")))
                for total in ("encoded_frames_total", "encode_seconds_total")
            )  # fmt: skip
            rate_hz = (count - before.get(name, 0)) / time_s
            if rate_hz == 0 or encoded == 0:
                continue
            sizes = [getattr(probe, kind).get(name, []) for kind in KINDS]
            found["streams"][name] = {
                "rate_hz": round(rate_hz, 2),
                "delta_bytes": round(statistics.mean(sizes[0])) if sizes[0] else 0,
                "keyframe_bytes": round(statistics.mean(sizes[1])) if sizes[1] else 0,
                "encode_s": float(f"{encode_s / encoded:.4g}"),
            }
            found["level_streams"][level].append(name)
        if level == "coarse":
            delays = [result["delay_p50_ms"] / 1e3, result["delay_p99_ms"] / 1e3]
            control = probe
    client.close()
    found["origin_delay_p50_s"], found["origin_delay_p99_s"] = delays
    found["watching_bytes"] = control.mean("watching")
    found["link_pulse_bytes"] = control.mean("link_pulse")
    found["view_bytes"] = control.mean("view")
    found["arrival_bytes"] = (control.mean("arrive") or 0.0) + (control.mean("admitted") or 0.0)
    found["command_bytes"] = (control.mean("command") or 0.0) + (control.mean("outcome") or 0.0)
    found["server_pulse_bytes"] = control.mean("server_pulse")
    news = control.control.get("news", [])
    found["news_messages_per_s"] = len(news) / control.seconds
    found["news_bytes_per_s"] = sum(news) / control.seconds
    return found


def measure(cluster: Cluster, cases: list, seconds: float) -> dict:
    """`cases`: (edges, clients per edge, level) each."""
    server = cluster.add_server("s1")
    edge_count = max(edges for edges, _, _ in cases)
    edges = [cluster.add_edge(f"e{k + 1}") for k in range(edge_count)]
    time.sleep(2)
    probe = BusProbe(NatsClient(cluster.url), "spindrift", lambda stream, level: "")
    probe.listen(seconds)
    probe.client.close()
    a = Snapshot(cluster, edges)
    time.sleep(seconds)
    idle = Rates(a, Snapshot(cluster, edges))
    memory = [edge.memory_bytes() for edge in edges]
    found = {
        "room_thread_share": statistics.mean(probe.loads["s1"]),
        "room_cpu": idle.server_cpu,
        "edge_memory_bytes": statistics.mean(memory),
    }
    found |= measure_streams(cluster, edges, seconds)
    found["greeting_bytes"] = greeting_bytes(edges[0].port)  # afterwards, so that the first attach was seen
    edge_rows, edge_values = [idle.edge_row(k) for k in range(edge_count)], [idle.edge_cpu(k) for k in range(edge_count)]
    nats_names = ("in_msgs", "out_msgs", "out_bytes")
    nats_rows, nats_values = [[1.0, *(idle.nats[n] for n in nats_names)]], [idle.nats_cpu]
    origin_rows, origin_values, joins, memories, bench = [], [], [], [], []
    print("edges clients level   frames  p50 ms  p99 ms  CPU: server  watching   edges    nats   bench  NATS in, out Mbit/s  others")
    for case_edges, each, level in cases:
        clients = case_edges * each
        used = edges[:case_edges]
        result, came, rates, memory = run_load(cluster, used, clients, level, seconds)
        edge_rows += [rates.edge_row(k) for k in range(case_edges)]
        edge_values += [rates.edge_cpu(k) for k in range(case_edges)]
        nats_rows.append([1.0, *(rates.nats[n] for n in nats_names)])
        nats_values.append(rates.nats_cpu)
        encode = rates.server("spindrift_encode_seconds_total")
        origin_rows.append([rates.server("spindrift_cluster_published_frames_total"), case_edges, 1.0])
        origin_values.append(max(0.0, rates.watching_cpu - encode))
        joins += [(each, came.edge_row(k), came.edge_cpu(k), came.time_s) for k in range(case_edges)]
        memories += [(each, one) for one in memory]
        sent = sum(rates.edge(k, "spindrift_sent_frames_total") for k in range(case_edges))
        bench.append(rates.load_cpu / sent)
        print(f"{case_edges:5} {clients:7} {level:7} {result['surface_frames_median']:6.0f} {result['delay_p50_ms']:7.2f}"
              f" {result['delay_p99_ms']:7.2f} {rates.server_cpu:12.3f} {rates.watching_cpu:9.3f}"
              f" {sum(rates.edge_cpu(k) for k in range(case_edges)):7.3f} {rates.nats_cpu:7.3f} {rates.load_cpu:7.3f}"
              f" {8e-6 * rates.nats['in_bytes']:8.2f} {8e-6 * rates.nats['out_bytes']:8.2f} {rates.other_cpu:9.2f}", flush=True)  # fmt: skip
    edge = fit(edge_rows, edge_values)
    found |= dict(zip(EDGE_COSTS, edge))
    nats = fit(nats_rows, nats_values)
    found |= dict(zip(NATS_COSTS, nats))
    origin = fit(origin_rows, origin_values)
    found["origin_cpu_per_published_frame_s"], found["origin_cpu_per_link_s"] = origin[0], origin[1]
    found["origin_idle_cpu"] = found["room_cpu"]
    # What is left of the time in which clients came, after the frames of that time.
    rests = [cpu * time_s - sum(a * b for a, b in zip(edge, row)) * time_s for _, row, cpu, time_s in joins]
    found["edge_cpu_per_join_s"] = max(0.0, sum(rests) / sum(each for each, _, _, _ in joins))
    base, per_client = fit([[1.0, each] for each, _ in memories], [value for _, value in memories])
    found["edge_memory_bytes"], found["edge_memory_per_client_bytes"] = max(base, found["edge_memory_bytes"]), per_client
    found["bench_cpu_per_frame_s"] = statistics.median(bench)
    found["room_memory_bytes"] = server.memory_bytes()
    found["nats_memory_bytes"] = cluster.nats.memory_bytes()
    errors = [abs(sum(a * b for a, b in zip(edge, row)) - value) for row, value in zip(edge_rows, edge_values)]
    print(f"  CPU of an edge: largest error of the fit {max(errors):.4f} cores")
    return {name: round_value(value) for name, value in found.items()}


def round_value(value):
    return float(f"{value:.4g}") if isinstance(value, float) else value

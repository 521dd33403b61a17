"""Compares the model with this machine: 3 servers, 4 edges, several numbers of clients, and the death of a server."""
import os
import signal
import time

from cluster_processes import Cluster
from failover_model import FailoverScenario, simulate
from fanout_model import FanoutModel, FanoutScenario, level_rate_hz
from measured_costs import ARRIVALS_PER_S, SETTLE_S, run_load

SERVERS, EDGES = 3, 4
BACKLOG_MAX_S = 0.2  # with more work waiting at the end, the delay only says how long the run was
DEATH_S = 12.0  # measured time of the case in which the server dies


def predict(values, clients: int, seconds: float, rate_factor: float) -> dict:
    """All processes and the bench share this machine: its load slows every job down, and the room with it."""
    scenario = FanoutScenario(clients=clients, edges=EDGES, level_shares={"coarse": 1.0}, arrivals_per_s=ARRIVALS_PER_S,
                              churn_per_s=0.0, commands_per_s=0.0, measured_s=seconds, warm_up_s=SETTLE_S,
                              rate_factor=rate_factor, receiver_s=values["bench_cpu_per_frame_s"])  # fmt: skip
    cores = os.cpu_count()
    result = {}
    for _ in range(2):
        result = FanoutModel(values, scenario).run()
        sent_per_s = clients * len(values["level_streams"]["coarse"]) * level_rate_hz(values, "coarse")
        bench = sent_per_s * rate_factor * values["bench_cpu_per_frame_s"]
        busy = (result["edges_cpu_cores"] + result["origin_cpu_cores"] + result["nats_cpu_cores"] + bench) / cores
        # The time in a queue with `cores` servers, over the working time.
        scenario.slowdown = 1.0 / (1.0 - min(0.97, busy) ** cores)
        result["machine_busy_share"] = busy
    return result


def line(what: str, predicted: float, measured: float, unit: str):
    ratio = f"{predicted / measured:7.2f}" if measured else "      -"
    print(f"  {what:<34} {predicted:10.3f} {measured:10.3f} {ratio}  {unit}", flush=True)


def check(cluster: Cluster, values, client_counts: list, seconds: float):
    for k in range(SERVERS):
        cluster.add_server(f"s{k + 1}")
    edges = [cluster.add_edge(f"e{k + 1}") for k in range(EDGES)]
    time.sleep(2)
    print(f"{'':36} {'predicted':>10} {'measured':>10} {'ratio':>7}")
    for clients in client_counts:
        result, _, rates, memory = run_load(cluster, edges, clients, "coarse", seconds)
        surface = next(s for name, s in values["streams"].items() if name == "surface.coarse")
        measured_hz = result["surface_frames_median"] / result["seconds"]
        rate_factor = min(1.0, measured_hz / surface["rate_hz"])
        free = predict(values, clients, seconds, 1.0)
        predicted = predict(values, clients, seconds, rate_factor)
        print(f"{clients} clients, {EDGES} edges, coarse: at full rate {free['machine_busy_share']:.2f} of the CPUs would be busy; "
              f"other programs took {rates.other_cpu:.2f} CPUs")  # fmt: skip
        line("surface frames per client", surface["rate_hz"], measured_hz, "1/s; the next lines are for the measured rate")
        backlog_s = max(predicted["edge_backlog_s"], predicted["receiver_backlog_s"])
        if backlog_s > BACKLOG_MAX_S:
            print(f"  delay: the model says overload; measured p50 {result['delay_p50_ms']:.1f}, p99 {result['delay_p99_ms']:.1f} ms")
        else:
            line("delay p50", predicted["delay_p50_ms"], result["delay_p50_ms"], "ms")
            line("delay p99", predicted["delay_p99_ms"], result["delay_p99_ms"], "ms")
        line("to clients", predicted["client_mbit_per_s"], result["received_mbit_per_s"], "Mbit/s")
        line("CPU of all edges", predicted["edges_cpu_cores"], sum(rates.edge_cpu(k) for k in range(EDGES)), "cores")
        line("CPU of the room's server", predicted["origin_cpu_cores"], rates.server_cpu, "cores")
        line("CPU of NATS", predicted["nats_cpu_cores"], rates.nats_cpu, "cores")
        line("NATS in", predicted["nats_in_mbit_per_s"], 8e-6 * rates.nats["in_bytes"], "Mbit/s")
        line("NATS out", predicted["nats_out_mbit_per_s"], 8e-6 * rates.nats["out_bytes"], "Mbit/s")
        line("memory of an edge, largest", predicted["edge_memory_mb"], 1e-6 * max(memory), "MB")
        time.sleep(1)
    check_death(cluster, values, edges, client_counts[-1])


def check_death(cluster: Cluster, values, edges: list, clients: int):
    scenario = FailoverScenario(rooms=1, servers=SERVERS, room_max_count=8, edges_per_room=EDGES, runs=50)
    predicted = simulate(values, scenario)
    load = cluster.start_load(edges, clients, "coarse", DEATH_S, 0.0)
    try:
        time.sleep(clients / ARRIVALS_PER_S + SETTLE_S + 2.0)
        cluster.servers["s1"].end(signal.SIGKILL)
        result = cluster.load_result(load)
    finally:
        load.end()
    print(f"death of the room's server under {clients} clients; predicted {predicted['failover_fastest_s']:.2f} to "
          f"{predicted['failover_max_s']:.2f} s without other load")  # fmt: skip
    line("longest gap of a client, median", predicted["failover_p50_s"], result["longest_gap_p50_ms"] / 1e3, "s")
    line("longest gap of a client, longest", predicted["failover_max_s"], result["longest_gap_max_ms"] / 1e3, "s")
    found = [float(one[1]) for edge in edges for _, one in edge.log_times(r"reached again after ([\d.]+) s")]
    print(f"  the edges reached the room again after {', '.join(f'{value:.2f}' for value in found)} s")

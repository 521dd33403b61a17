#!/usr/bin/env python3
"""Runs a server and an edge under the load of people who come and go, and judges memory, descriptors, ticks and answers.

`soak.py --program PATH --minutes 60 --csv FILE` starts a NATS server, a server that keeps its rooms on disk, an edge, and
clients of both (`spindrift-bench --suite soak`) on loopback. Meanwhile rooms are opened and closed over REST, and parameters
and scenes change. Ends with 1 if a bound is missed, 2 for wrong arguments. Nothing else should run on the machine.
"""
import argparse
import csv
import json
import math
import pathlib
import re
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "capacity"))

import disturbances
import histogram
import load_rows
from cluster_processes import Cluster, Process
from process_samples import read_process
from verdict import judge

ROOT = pathlib.Path(__file__).resolve().parents[3]
TICK_METRIC, MAIN = "spindrift_room_tick_seconds", 'room="main"'
TICK_RATE_HZ = 60.0  # of scenes that do not say it


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=pathlib.Path, required=True, help="the built program spindrift, with spindrift-bench beside it")
    parser.add_argument("--minutes", type=float, default=60.0, help="in all, the warm-up included")
    parser.add_argument("--warm-up-minutes", type=float, default=10.0)
    parser.add_argument("--scene", default="pool", help="shipped scene or file; boats are added if it has none")
    parser.add_argument("--clients", type=int, default=40)
    parser.add_argument("--churn-per-s", type=float, default=1.0)
    parser.add_argument("--strokes-per-s", type=float, default=0.1)
    parser.add_argument("--csv", type=pathlib.Path, help="writes the samples to this file")
    parser.add_argument("--sample-s", type=float, default=10.0)
    parser.add_argument("--parameter-every-s", type=float, default=15.0)
    parser.add_argument("--room-every-s", type=float, default=120.0)
    parser.add_argument("--scene-every-s", type=float, default=240.0)
    parser.add_argument("--memory-mb-per-h", type=float, default=1.0, help="bound")
    parser.add_argument("--ack-budget-ms", type=float, help="bound of the 99th percentile; 50 ms and one tick if left out")
    parser.add_argument("--seed", type=int, default=1)
    out = parser.parse_args()
    if out.minutes <= out.warm_up_minutes:
        parser.error(f"--minutes {out.minutes:g} must be more than --warm-up-minutes {out.warm_up_minutes:g}")
    return out


def write_scene(name: str, folder: pathlib.Path) -> tuple[pathlib.Path, float]:
    """Writes the scene, with boats, into the folder; returns the file and its ticks per second."""
    file = pathlib.Path(name) if "/" in name or name.endswith(".textproto") else ROOT / "server/scenes" / f"{name}.textproto"
    text = file.read_text(encoding="utf-8")
    if not re.search(r"^boats\b", text, re.MULTILINE):
        text += "\nboats { capacity_count: 8 }\n"
    rate = re.search(r"^tick_rate_hz: *([\d.]+)", text, re.MULTILINE)
    out = folder / "soak.textproto"
    out.write_text(text, encoding="utf-8")
    return out, float(rate[1]) if rate else TICK_RATE_HZ


class Samples:
    """Takes a row of everything, again and again."""

    def __init__(self, processes: dict, load: Process, disturber: disturbances.Disturber):
        self.processes, self.load, self.disturber = processes, load, disturber
        self.begin_s = time.monotonic()
        self.rows, self.ticks = [], []
        self.last_ticks = histogram.buckets_of(processes["server"].metrics(), TICK_METRIC, MAIN)

    def take(self):
        row = {"time_s": round(time.monotonic() - self.begin_s, 2), "calm": int(self.disturber.is_calm())}
        metrics = {name: self.processes[name].metrics() for name in ("server", "edge")}
        ticks = histogram.buckets_of(metrics["server"], TICK_METRIC, MAIN)
        passed = histogram.difference(ticks, self.last_ticks)
        self.last_ticks = ticks
        row["ticks"] = passed[math.inf]
        for label, ratio in (("tick_p50_ms", 0.5), ("tick_p99_ms", 0.99)):
            row[label] = round(1e3 * histogram.quantile(passed, ratio), 3)
        row["real_time_factor"] = metrics["server"][f"spindrift_room_real_time_factor{{{MAIN}}}"]
        row["rooms"] = sum(1 for key in metrics["server"] if key.startswith("spindrift_room_speed{"))
        for name, process in self.processes.items():
            row |= {f"{name}_{key}": value for key, value in read_process(process.child.pid).items()}
            if name in metrics:
                row[f"{name}_connections"] = metrics[name]["spindrift_connections"]
        load = load_rows.newest_row(self.load.log.read_text(encoding="utf-8"))
        row |= {f"load_{key}": value for key, value in load.items() if key != "time_s"}
        self.rows.append(row)
        self.ticks.append(passed)
        return row

    def write(self, file: pathlib.Path):
        names = list(dict.fromkeys(name for row in self.rows for name in row))
        with file.open("w", newline="", encoding="utf-8") as out:
            writer = csv.DictWriter(out, names, restval="")
            writer.writeheader()
            writer.writerows(self.rows)


def start_load(cluster: Cluster, ports: list[int], arguments) -> Process:
    # Most clients are in the room that is always there.
    rooms = ["", "", "", *(f"/{name}" for name in disturbances.ROOMS)]
    urls = [part for room in rooms for port in ports for part in ("--url", f"ws://127.0.0.1:{port}/ws{room}")]
    warm_up_s = 60.0 * arguments.warm_up_minutes
    command = [cluster.program + "-bench", "--suite", "soak", *urls, "--clients", str(arguments.clients),
               "--seconds", str(60.0 * arguments.minutes - warm_up_s), "--warm-up-s", str(warm_up_s),
               "--interval-s", str(arguments.sample_s), "--churn-per-s", str(arguments.churn_per_s),
               "--strokes-per-s", str(arguments.strokes_per_s), "--seed", str(arguments.seed), "--json", "soak.json"]  # fmt: skip
    return Process("load", command, cluster.folder)


def show(row: dict):
    print(f"{row['time_s']:7.0f} s {'calm ' if row['calm'] else 'other'} {row['rooms']} rooms, RSS {row['server_rss_mb']:.1f} {row['edge_rss_mb']:.1f} MB,"
          f" descriptors {row['server_descriptors']} {row['edge_descriptors']}, tick p99 {row['tick_p99_ms']:.1f} ms,"
          f" real time {row['real_time_factor']:.2f}, ack p99 {row.get('load_p99_ms', math.nan):.1f} ms", flush=True)  # fmt: skip


def soak(cluster: Cluster, arguments) -> int:
    scene, tick_rate_hz = write_scene(arguments.scene, cluster.folder)
    cluster.scene = str(scene)
    server, edge = cluster.add_server("s1"), cluster.add_edge("e1")
    edge.wait_for("/readyz")
    ports = [server.port, edge.port]
    intervals_s = {"parameter": arguments.parameter_every_s, "room": arguments.room_every_s, "change_scene": arguments.scene_every_s}
    disturber = disturbances.Disturber(ports, scene.stem, intervals_s, 60.0 * arguments.warm_up_minutes, arguments.seed)
    load = start_load(cluster, ports, arguments)
    samples = Samples({"server": server, "edge": edge, "nats": cluster.nats}, load, disturber)
    disturber.start()
    try:
        next_s = samples.begin_s + arguments.sample_s
        while load.child.poll() is None:
            time.sleep(max(0.0, next_s - time.monotonic()))
            next_s += arguments.sample_s
            for process in (server, edge, cluster.nats):
                if process.child.poll() is not None:
                    raise RuntimeError(f"{process.name} ended with {process.child.returncode}:\n" + process.log.read_text()[-2000:])
            if load.child.poll() is None:
                show(samples.take())
                if arguments.csv:
                    samples.write(arguments.csv)
    finally:
        load.end()
        disturber.stop()
    if load.child.returncode != 0:
        raise RuntimeError("the load failed:\n" + load.log.read_text()[-2000:])
    if disturber.error:
        raise RuntimeError(f"a request to servers failed: {disturber.error}")
    result = json.loads((cluster.folder / "soak.json").read_text())
    print("requests: " + ", ".join(f"{what} {status}: {count}" for (what, status), count in sorted(disturber.answers.items())))
    warm = [k for k, row in enumerate(samples.rows) if row["time_s"] > 60.0 * arguments.warm_up_minutes]
    verdict = judge([samples.rows[k] for k in warm], [samples.ticks[k] for k in warm], result, arguments, tick_rate_hz)
    print("\n".join(verdict.lines))
    for line in verdict.missed:
        print(f"soak.py: missed: {line}", file=sys.stderr)
    return 1 if verdict.missed else 0


def main() -> int:
    arguments = read_arguments()
    try:
        with Cluster(str(arguments.program.resolve()), arguments.scene) as cluster:
            return soak(cluster, arguments)
    except (RuntimeError, OSError, KeyError, ValueError) as error:
        print(f"soak.py: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Measures the parameters of the capacity model on this machine, and compares its predictions with measurements.

`capacity_measure.py --program PATH --write FILE` starts a NATS server, servers, edges and the load bench on loopback,
fits the costs, and writes all measured parameters. `--check` runs 3 servers and 4 edges with --clients and kills the
server of the room in the last case. Nothing else should run on the machine meanwhile.
"""
import argparse
import os
import pathlib
import platform
import sys

import measured_costs
import parameters as parameter_file
from cluster_check import check
from cluster_processes import Cluster
from measured_directory import measure_builds, measure_directory


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=pathlib.Path, required=True, help="the built program spindrift, with spindrift-bench beside it")
    parser.add_argument("--scene", default="harbor")
    parser.add_argument("--parameters", type=pathlib.Path, default=parameter_file.DEFAULT_FILE)
    parser.add_argument("--write", type=pathlib.Path, help="measure, and write the parameters to this file")
    parser.add_argument("--parts", default="costs,directory,builds", help="of what --write measures; the other values stay")
    parser.add_argument("--check", action="store_true", help="compare predictions with measurements")
    parser.add_argument("--seconds", type=float, default=4.0, help="measured time of each case")
    parser.add_argument("--cases", default="1x50:coarse,1x100:coarse,1x200:coarse,2x50:coarse,4x50:coarse,1x30:medium,1x20:full",
                        help="EDGESxCLIENTS_PER_EDGE:LEVEL, separated by commas")  # fmt: skip
    parser.add_argument("--builds", type=int, default=3, help="deaths of a server, for the time of building a room")
    parser.add_argument("--clients", default="250,500,1000", help="for --check: numbers of clients")
    return parser.parse_args()


def measure(arguments, values: parameter_file.Parameters):
    cases = []
    for text in arguments.cases.split(","):
        sizes, _, level = text.partition(":")
        edges, _, clients = sizes.partition("x")
        cases.append((int(edges), int(clients), level))
    program = str(arguments.program.resolve())
    parts = {
        "costs": lambda cluster: measured_costs.measure(cluster, cases, arguments.seconds),
        "directory": measure_directory,
        "builds": lambda cluster: measure_builds(cluster, arguments.builds),
    }
    wanted = arguments.parts.split(",")
    if unknown := set(wanted) - parts.keys():
        raise RuntimeError(f"--parts {','.join(sorted(unknown))}: there are {', '.join(parts)}")
    found = {}
    for part in wanted:
        with Cluster(program, arguments.scene) as cluster:
            found |= parts[part](cluster)
    source = f"capacity_measure.py --scene {arguments.scene} --seconds {arguments.seconds:g}, {os.cpu_count()} CPUs, {cpu_name()}"
    for name, value in found.items():
        values.set(name, value, source)
    values.save(arguments.write)
    missing = values.missing()
    print(f"{len(found)} parameters written to {arguments.write}" + (f"; still missing: {', '.join(missing)}" if missing else ""))


def cpu_name() -> str:
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    return platform.machine()


def main() -> int:
    arguments = read_arguments()
    if not arguments.write and not arguments.check:
        print("capacity_measure.py: nothing to do: give --write FILE or --check", file=sys.stderr)
        return 2
    try:
        print(f"load average before: {os.getloadavg()[0]:.2f} (other load makes the figures worse)")
        values = parameter_file.Parameters.load(arguments.parameters)
        if arguments.write:
            measure(arguments, values)
        if arguments.check:
            if missing := values.missing():
                raise parameter_file.ParameterError(f"{values.name}: {', '.join(missing)} were not measured: run with --write FILE")
            with Cluster(str(arguments.program.resolve()), arguments.scene) as cluster:
                check(cluster, values, [int(n) for n in arguments.clients.split(",")], arguments.seconds)
    except (parameter_file.ParameterError, RuntimeError, OSError) as error:
        print(f"capacity_measure.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())

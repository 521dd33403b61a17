#!/usr/bin/env python3
"""Predicts what a cluster needs, by simulation with measured parameters: `capacity_model.py [OPTIONS]`.

--case fanout: one room with --clients behind --edges. --case failover: --rooms over --servers, one of which dies.
docs/capacity.md describes the model. Fails if a parameter was not measured.
"""
import argparse
import json
import pathlib
import sys

import parameters as parameter_file
from failover_model import FailoverScenario, simulate
from fanout_model import FanoutModel, FanoutScenario


def shares(text: str) -> dict:
    """Reads `coarse=0.7,full=0.3`."""
    out = {}
    for part in text.split(","):
        name, _, value = part.partition("=")
        out[name] = float(value)
    return out


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--case", choices=["fanout", "failover"], required=True)
    parser.add_argument("--parameters", type=pathlib.Path, default=parameter_file.DEFAULT_FILE)
    parser.add_argument("--json", help="write the result as JSON to this file, - = standard output")
    parser.add_argument("--seed", type=int, default=1)
    fanout = parser.add_argument_group("fanout")
    fanout.add_argument("--clients", type=int, default=FanoutScenario.clients)
    fanout.add_argument("--edges", type=int, default=FanoutScenario.edges)
    fanout.add_argument("--levels", type=shares, default=None, help="default: coarse=0.7,medium=0.2,full=0.1")
    fanout.add_argument("--arrivals-per-s", type=float, default=FanoutScenario.arrivals_per_s, help="0: all at the start")
    fanout.add_argument("--churn-per-s", type=float, default=FanoutScenario.churn_per_s)
    fanout.add_argument("--edge-death", action="store_true", help="one edge dies; its clients go to the others")
    fanout.add_argument("--seconds", type=float, default=FanoutScenario.measured_s)
    failover = parser.add_argument_group("failover")
    failover.add_argument("--rooms", type=int, default=FailoverScenario.rooms)
    failover.add_argument("--servers", type=int, default=FailoverScenario.servers)
    failover.add_argument("--room-max-count", type=int, default=FailoverScenario.room_max_count)
    failover.add_argument("--room-share", type=float, default=None, help="default: room_thread_share of the parameters")
    failover.add_argument("--ignores-claimed", action="store_true", help="a rule of placement that does not count rooms that are being opened")
    failover.add_argument("--build-s", type=float, default=None, help="try another time of building a room")
    failover.add_argument("--runs", type=int, default=FailoverScenario.runs)
    return parser.parse_args()


def predict(arguments) -> dict:
    values = parameter_file.Parameters.load(arguments.parameters)
    if missing := values.missing():
        raise parameter_file.ParameterError(
            f"{arguments.parameters}: {len(missing)} parameters were not measured ({', '.join(missing)}): "
            "run capacity_measure.py --program PATH --write FILE"
        )
    if arguments.case == "failover":
        if arguments.build_s is not None:
            for name in ("room_build_p50_s", "room_build_p99_s"):
                values.set(name, arguments.build_s, "--build-s")
        return simulate(values, FailoverScenario(
            rooms=arguments.rooms, servers=arguments.servers, room_max_count=arguments.room_max_count,
            room_thread_share=arguments.room_share, ignores_claimed=arguments.ignores_claimed, runs=arguments.runs,
            seed=arguments.seed))  # fmt: skip
    scenario = FanoutScenario(
        clients=arguments.clients, edges=arguments.edges, arrivals_per_s=arguments.arrivals_per_s,
        churn_per_s=arguments.churn_per_s, edge_death=arguments.edge_death, measured_s=arguments.seconds,
        seed=arguments.seed)  # fmt: skip
    if arguments.levels:
        scenario.level_shares = arguments.levels
    return FanoutModel(values, scenario).run()


def main() -> int:
    arguments = read_arguments()
    try:
        result = predict(arguments)
    except (parameter_file.ParameterError, ValueError) as error:
        print(f"capacity_model.py: {error}", file=sys.stderr)
        return 1
    if arguments.json == "-":
        print(json.dumps(result))
        return 0
    for name, value in result.items():
        text = f"{value:.4g}" if isinstance(value, float) else "-" if value is None else value
        print(f"{name:<34} {text}")
    if arguments.json:
        pathlib.Path(arguments.json).write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())

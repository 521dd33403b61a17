"""Discrete-event simulation of a cluster of servers that run rooms, one of which dies.

Each server tells its load in pulses, looks at its copy of the directory of rooms at an interval, and asks NATS once
before it takes the rooms that the common rule of placement gives to it; it builds them one after the other. Nodes with
watchers attach again. As in server/cluster/directory.cpp and placement.cpp, a server decides by the pulses and the
entries that it knows, so two servers can disagree for a moment; the write of an entry settles it. Copies of the
directory follow at once.
"""
import dataclasses
import random

from events import EventQueue, Samples, Worker, log_normal


@dataclasses.dataclass
class FailoverScenario:
    rooms: int = 200
    servers: int = 20
    room_max_count: int = 16  # --max-rooms of each server
    edges_per_room: int = 3  # nodes whose clients watch it
    room_thread_share: float | None = None  # None: that of the parameters
    # Placement counts rooms that a server has claimed and that its pulses do not show yet.
    ignores_claimed: bool = False
    runs: int = 20
    seed: int = 1
    end_s: float = 120.0


class Server:
    def __init__(self, name: str):
        self.name = name
        self.alive = True
        self.rooms = set()  # that run
        self.known_rooms = frozenset()  # as its last pulse said
        self.known_load = 0.0
        self.heard_s = 0.0
        self.builder = Worker()
        self.opening = set()
        self.orphans = {}  # since when it knows them
        self.review_until_s = 0.0
        self.taken_count = 0


class FailoverModel:
    def __init__(self, parameters, scenario: FailoverScenario, seed: int):
        self.p = parameters
        self.s = scenario
        self.share = parameters["room_thread_share"] if scenario.room_thread_share is None else scenario.room_thread_share
        self.random = random.Random(seed)
        self.queue = EventQueue()
        self.servers = [Server(f"s{k:03}") for k in range(scenario.servers)]
        self.owner = {}
        self.nats = Worker()  # answers the checks of the directory
        self.claimed_s, self.opened_s, self.seen_s = {}, {}, {}
        self.checks = self.writes = self.pulses_in = self.pulses_out = self.attach_messages = self.lost_writes = 0
        self.died_s = None
        self.place()

    # ---- placement --------------------------------------------------------------------------------------------------

    def load(self, server: Server) -> float:
        return min(1.0, self.share * len(server.rooms))

    def place(self):
        """Rooms that were opened one after the other, each on the least loaded server that may have more."""
        for k in range(self.s.rooms):
            free = [one for one in self.servers if len(one.rooms) < self.s.room_max_count]
            if not free:
                raise ValueError(
                    f"{self.s.rooms} rooms do not fit on {self.s.servers} servers with {self.s.room_max_count} each: "
                    "give more servers or a larger --room-max-count"
                )
            # By their number where all are fully loaded: the load says no more then.
            target = min(free, key=lambda one: (self.load(one), len(one.rooms), one.name))
            room = f"r{k:04}"
            target.rooms.add(room)
            self.owner[room] = target

    def is_alive(self, server: Server) -> bool:
        """As its pulses tell the others."""
        return self.queue.now_s - server.heard_s <= self.p["server_patience_s"]

    def choose(self, placed: dict) -> Server | None:
        """Servers::choose()."""
        best, least = None, float("inf")
        for server in self.servers:
            late = placed.get(server.name, 0)
            if not self.is_alive(server) or len(server.known_rooms) + late >= self.s.room_max_count:
                continue
            load = server.known_load + self.p["placed_room_load"] * late
            if load < least:
                best, least = server, load
        return best

    # ---- servers ----------------------------------------------------------------------------------------------------

    def pulse(self, server: Server):
        if not server.alive:
            return
        server.heard_s = self.queue.now_s
        server.known_rooms = frozenset(server.rooms)
        server.known_load = self.load(server)
        self.pulses_in += 1
        self.pulses_out += len(self.servers) - 1

    def review(self, server: Server):
        """Directory::reviewNow(): decides by its copy; if there is something to do, asks NATS and decides anew."""
        now_s = self.queue.now_s
        if not server.alive or now_s < server.review_until_s or not self.decide(server):
            return
        self.checks += 1
        queued_s = self.nats.do(now_s, self.p["nats_cpu_per_directory_check_s"]) - now_s
        server.review_until_s = now_s + max(queued_s, self.p["directory_check_s"])
        self.queue.at(server.review_until_s, lambda: self.act(server))

    def act(self, server: Server):
        if not server.alive:
            return
        now_s = self.queue.now_s
        taken = self.decide(server)
        for k, one in enumerate(taken):
            self.queue.at(now_s + (k + 1) * self.p["directory_write_s"], lambda one=one: self.take(server, *one))
        server.review_until_s = now_s + len(taken) * self.p["directory_write_s"]

    def check(self, server: Server):
        """KeyValues::copy() compares its newest revision with that of the bucket."""
        if server.alive:
            self.checks += 1

    def decide(self, server: Server) -> list:
        """Directory::decide(): the rooms to take, each with the owner that its entry names."""
        now_s = self.queue.now_s
        placed, orphans, taken = {}, {}, []
        for room, owner in self.owner.items():
            if not self.s.ignores_claimed and self.is_alive(owner) and room not in owner.known_rooms:
                placed[owner.name] = placed.get(owner.name, 0) + 1
            if room in server.rooms or room in server.opening:
                continue
            if owner is not server and self.is_alive(owner):
                continue
            since_s = server.orphans.get(room, now_s)
            orphans[room] = since_s
            chosen = self.choose(placed)
            if chosen:
                placed[chosen.name] = placed.get(chosen.name, 0) + 1
            if chosen is server or now_s - since_s >= self.p["chosen_patience_s"]:
                taken.append((room, owner))
        server.orphans = orphans
        return taken

    def take(self, server: Server, room: str, read_owner: Server):
        if self.owner[room] is not read_owner:
            self.lost_writes += 1  # another server was faster
            return
        now_s = self.queue.now_s
        self.writes += 1
        self.owner[room] = server
        server.opening.add(room)
        server.taken_count += 1
        self.claimed_s[room] = now_s
        build_s = log_normal(self.random, self.p["room_build_p50_s"], self.p["room_build_p99_s"])
        self.queue.at(server.builder.do(now_s, build_s), lambda: self.open(server, room))

    def open(self, server: Server, room: str):
        server.opening.discard(room)
        server.rooms.add(room)
        self.opened_s[room] = self.queue.now_s
        self.nodes_attach(room)

    # ---- nodes ------------------------------------------------------------------------------------------------------

    def nodes_attach(self, room: str):
        """The nodes of the room's watchers try again and again; the first try after the room listens succeeds."""
        p, opened_s = self.p, self.opened_s[room]
        round_s = p["node_round_s"]
        listens_s = opened_s + self.random.random() * round_s  # the feed opens the room in the server's next round
        frame_interval_s = 1.0 / max(s["rate_hz"] for name, s in self.p["streams"].items() if name.startswith("surface"))
        last_s = 0.0
        for _ in range(self.s.edges_per_room):
            # The last message came up to a pulse before the death; silence is noticed in the next round of the node.
            heard_s = self.died_s - self.random.random() * p["link_pulse_interval_s"]
            try_s = heard_s + p["room_patience_s"] + self.random.random() * round_s
            # Tries come with the first round after the interval.
            step_s = (int(p["attach_interval_s"] / round_s) + 1) * round_s
            tries = 1 if try_s >= listens_s else 1 + -int(-(listens_s - try_s) // step_s)
            self.attach_messages += tries
            attached_s = try_s + (tries - 1) * step_s
            # View back, report of what is watched there, next frame.
            seen_s = attached_s + 4 * p["network_latency_s"] * 2 + self.random.random() * frame_interval_s
            last_s = max(last_s, seen_s + p["origin_delay_p50_s"])
        self.seen_s[room] = last_s

    # ---- the run ----------------------------------------------------------------------------------------------------

    def run(self) -> dict:
        p = self.p
        for server in self.servers:
            phase_s = self.random.random() * p["server_pulse_interval_s"]
            self.queue.every(p["server_pulse_interval_s"], phase_s, lambda server=server: self.pulse(server))
            phase_s = self.random.random() * p["directory_interval_s"]
            self.queue.every(p["directory_interval_s"], phase_s, lambda server=server: self.review(server))
            phase_s = self.random.random() * p["directory_check_interval_s"]
            self.queue.every(p["directory_check_interval_s"], phase_s, lambda server=server: self.check(server))
        self.died_s = p["directory_check_interval_s"] + self.random.random()
        self.queue.run_until(self.died_s)
        steady = {"pulses_in": self.pulses_in, "pulses_out": self.pulses_out}
        dead = self.random.choice([one for one in self.servers if one.rooms])
        lost = sorted(dead.rooms)
        dead.alive = False
        dead.rooms = set()
        self.queue.run_until(self.died_s + self.s.end_s)
        left = [room for room in lost if room not in self.seen_s]
        alive = [one for one in self.servers if one.alive]
        return {
            "lost_rooms": len(lost),
            "rooms_not_back": len(left),
            "claim_s": [self.claimed_s[room] - self.died_s for room in lost if room in self.claimed_s],
            "failover_s": [self.seen_s[room] - self.died_s for room in lost if room not in left],
            "most_taken": max(one.taken_count for one in alive),
            "takers": sum(one.taken_count > 0 for one in alive),
            "most_rooms": max(len(one.rooms) for one in alive),
            "lost_writes": self.lost_writes,
            "attach_messages": self.attach_messages,
            "directory_writes": self.writes,
            "pulses_in_per_s": steady["pulses_in"] / self.died_s,
            "pulses_out_per_s": steady["pulses_out"] / self.died_s,
        }


def simulate(parameters, scenario: FailoverScenario) -> dict:
    """Repeats the death with other phases of all timers, and another server that dies."""
    runs = [FailoverModel(parameters, scenario, scenario.seed * 1000 + k).run() for k in range(scenario.runs)]
    claims, failovers = Samples(), Samples()
    for run in runs:
        for value in run["claim_s"]:
            claims.add(value)
        for value in run["failover_s"]:
            failovers.add(value)
    p = parameters
    share = p["room_thread_share"] if scenario.room_thread_share is None else scenario.room_thread_share
    mean_rooms = scenario.rooms / scenario.servers
    most_rooms = max(run["most_rooms"] for run in runs)
    checks_per_s = scenario.servers / p["directory_check_interval_s"]
    writes = sum(run["directory_writes"] for run in runs) / scenario.runs
    pulse_bytes = p["server_pulse_bytes"] + mean_rooms * 8
    return {
        "rooms": scenario.rooms,
        "servers": scenario.servers,
        "rooms_per_server": mean_rooms,
        "rooms_per_server_in_real_time": int(1.0 / share) if share > 0 else scenario.room_max_count,
        "real_time_factor_before": min(1.0, 1.0 / (share * mean_rooms)) if share * mean_rooms > 0 else 1.0,
        "real_time_factor_worst_after": min(1.0, 1.0 / (share * most_rooms)) if share * most_rooms > 0 else 1.0,
        "most_rooms_after": most_rooms,
        "most_taken_by_one": max(run["most_taken"] for run in runs),
        "takers_fewest": min(run["takers"] for run in runs),
        "rooms_not_back": sum(run["rooms_not_back"] for run in runs),
        "claim_p50_s": claims.quantile(0.5),
        "claim_max_s": claims.quantile(1.0),
        "failover_fastest_s": failovers.quantile(0.0),
        "failover_p50_s": failovers.quantile(0.5),
        "failover_p90_s": failovers.quantile(0.9),
        "failover_max_s": failovers.quantile(1.0),
        "lost_writes": sum(run["lost_writes"] for run in runs) / scenario.runs,
        "attach_messages": sum(run["attach_messages"] for run in runs) / scenario.runs,
        "directory_checks_per_s": checks_per_s,
        "directory_nats_cpu_cores": checks_per_s * p["nats_cpu_per_directory_check_s"],
        "directory_changes_after_death": writes,
        "directory_changes_told_after_death": writes * scenario.servers,
        "directory_nats_cpu_after_death_s": writes
        * (p["nats_cpu_per_directory_write_s"] + scenario.servers * p["nats_cpu_per_directory_change_told_s"]),
        "pulse_out_mbit_per_s": 8e-6 * runs[0]["pulses_out_per_s"] * pulse_bytes,
        "link_pulse_messages_per_s": 2 * scenario.rooms * scenario.edges_per_room / p["link_pulse_interval_s"],
    }

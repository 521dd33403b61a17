"""Discrete-event simulation of one room with many watchers behind edges.

A frame passes: encoder thread of the server -> routing and network link of the NATS server -> delivery thread of each
edge -> I/O thread and network link of the edge, one client after the other. Each of them does one job at a time, so
that queues and delays follow from the times of the jobs. Clients are counted, not simulated one by one: a batch of
frames to the n clients of a level is one job, and its delays are sampled at BATCH_SAMPLES places.
"""
import dataclasses
import math
import random

from events import EventQueue, Samples, Worker, log_normal

BATCH_SAMPLES = 8
# With so many clients on one edge the base delay of the parameters is measured.
CALIBRATION_CLIENTS = 10


@dataclasses.dataclass
class FanoutScenario:
    clients: int = 10_000
    edges: int = 50
    level_shares: dict = dataclasses.field(default_factory=lambda: {"coarse": 0.7, "medium": 0.2, "full": 0.1})
    arrivals_per_s: float = 500.0  # until all clients are there; 0: they are there from the start
    churn_per_s: float = 20.0  # afterwards: as many clients leave as come
    commands_per_s: float = 20.0  # of all clients
    edge_death: bool = False  # one edge dies at the beginning of the measured time
    measured_s: float = 10.0
    warm_up_s: float = 3.0
    seed: int = 1
    rate_factor: float = 1.0  # the room's real-time factor: its frames come so much slower
    slowdown: float = 1.0  # of all CPU work, where other processes share the cores
    receiver_s: float = 0.0  # CPU per frame of one process that plays all clients; 0: each has a machine of its own


class Edge:
    def __init__(self):
        self.alive = True
        self.clients = {}  # by level
        self.needy = {}  # by stream: those who need a keyframe since when (s)
        self.keyframes_until_s = {}  # by stream: takes the stream of keyframes until then
        self.delivery = Worker()
        self.io = Worker()
        self.link = Worker()
        self.cpu_s = 0.0
        self.sent_bytes = 0.0

    def client_count(self):
        return sum(self.clients.values())


def level_rate_hz(parameters, level: str) -> float:
    """Returns the frames per second of each stream for a client of this level: the rate of its slowest stream."""
    return min(parameters["streams"][name]["rate_hz"] for name in parameters["level_streams"][level])


class FanoutModel:
    def __init__(self, parameters, scenario: FanoutScenario):
        self.p = parameters
        self.s = scenario
        self.random = random.Random(scenario.seed)
        self.queue = EventQueue()
        self.streams = parameters["streams"]
        self.level_streams = parameters["level_streams"]
        for level in scenario.level_shares:
            if level not in self.level_streams:
                raise ValueError(f"level {level} is not in level_streams: {', '.join(self.level_streams)}")
        if abs(sum(scenario.level_shares.values()) - 1.0) > 1e-6:
            raise ValueError(f"the shares of the levels add up to {sum(scenario.level_shares.values())}, not 1")
        self.edges = [Edge() for _ in range(scenario.edges)]
        self.encoder, self.router, self.nats_link, self.receiver = Worker(), Worker(), Worker(), Worker()
        self.is_measuring = False
        self.wanted_keyframes = {}  # by stream: nodes that asked
        self.numbers = {}  # by stream: of the newest frame
        self.joined = 0
        self.next_edge = 0
        self.delays, self.first_frames = Samples(), Samples()
        self.nats = dict.fromkeys(
            ["frame_bytes_in", "frame_bytes_out", "keyframe_bytes_in", "keyframe_bytes_out", "control_bytes_in",
             "control_bytes_out", "messages_in", "messages_out"], 0.0)  # fmt: skip
        self.nats_cpu_s = self.origin_cpu_s = 0.0
        self.surface_frames = 0.0
        self.wire = 8.0 * (1.0 + parameters["wire_overhead_share"])
        self.base_p50_s = max(0.0, parameters["origin_delay_p50_s"] - self.unloaded_s())
        self.base_p99_s = max(self.base_p50_s, parameters["origin_delay_p99_s"] - self.unloaded_s())

    def unloaded_s(self) -> float:
        """Returns the time that the model itself gives the median frame where the base delay was measured."""
        p = self.p
        surface = next(s for name, s in self.streams.items() if name.startswith("surface"))
        bytes_count = surface["delta_bytes"] or surface["keyframe_bytes"]
        per_client_s = p["edge_cpu_per_frame_sent_s"] + bytes_count * p["edge_cpu_per_byte_sent_s"]
        return surface["encode_s"] + p["edge_cpu_per_frame_received_s"] + CALIBRATION_CLIENTS / 2 * per_client_s

    # ---- clients ----------------------------------------------------------------------------------------------------

    def draw_level(self) -> str:
        at = self.random.random()
        for level, share in self.s.level_shares.items():
            at -= share
            if at < 0.0:
                return level
        return next(iter(self.s.level_shares))

    def join(self, level: str, edge: Edge | None = None, since_s: float | None = None):
        """A client connects to an edge and needs a keyframe of each of its delta streams."""
        now_s = self.queue.now_s
        if edge is None:
            alive = [one for one in self.edges if one.alive]
            edge = alive[self.next_edge % len(alive)]
            self.next_edge += 1
        self.joined += 1
        self.work(edge, edge.io, self.p["edge_cpu_per_join_s"])
        ready_s = edge.link.do(edge.io.free_at_s, self.p["greeting_bytes"] * self.wire / self.p["edge_link_bit_per_s"])
        self.count_sent(edge, self.p["greeting_bytes"])
        if self.joined <= self.p["listed_people_max_count"]:
            self.control(self.p["arrival_bytes"] / 2, 2, 2)  # there and back
            self.news_of_people()

        def watch():
            edge.clients[level] = edge.clients.get(level, 0) + 1
            for name in self.level_streams[level]:
                if self.streams[name]["delta_bytes"] > 0:
                    self.need_keyframe(edge, name, since_s if since_s is not None else now_s)

        self.queue.at(ready_s, watch)

    def leave(self):
        edge = self.random.choice([one for one in self.edges if one.alive and one.client_count()])
        levels = list(edge.clients)
        level = self.random.choices(levels, [edge.clients[one] for one in levels])[0]
        edge.clients[level] -= 1

    def need_keyframe(self, edge: Edge, name: str, since_s: float):
        waiting = edge.needy.setdefault(name, [])
        waiting.append(since_s)
        edge.keyframes_until_s[name] = self.queue.now_s + self.p["keyframe_patience_s"]
        if len(waiting) > 1:
            return  # it has asked already
        self.control(self.p["watching_bytes"], 1, 1)
        arrives_s = self.queue.now_s + 2 * self.p["network_latency_s"]
        self.queue.at(arrives_s, lambda: self.wanted_keyframes.setdefault(name, set()).add(id(edge)))

    def kill_edge(self):
        dead = self.edges[0]
        dead.alive = False
        died_s = self.queue.now_s
        for level, count in dead.clients.items():
            for _ in range(count):
                pause_s = self.p["client_pause_s"]
                self.queue.at(died_s + pause_s, lambda level=level: self.join(level, since_s=died_s))
        dead.clients = {}
        dead.needy = {}

    # ---- accounts ---------------------------------------------------------------------------------------------------

    def work(self, edge: Edge, worker: Worker, work_s: float):
        if self.is_measuring:
            edge.cpu_s += work_s
        return worker.do(self.queue.now_s, work_s * self.s.slowdown)

    def count_sent(self, edge: Edge, bytes_count: float):
        if self.is_measuring:
            edge.sent_bytes += bytes_count

    def route(self, kind: str, bytes_in: float, receivers: float, messages_in: float = 1.0) -> float:
        """A message through the NATS server; returns when the last copy is on its way."""
        cpu_s = messages_in * self.p["nats_cpu_per_message_in_s"] + receivers * (
            self.p["nats_cpu_per_message_out_s"] + bytes_in * self.p["nats_cpu_per_byte_out_s"]
        )
        if self.is_measuring:
            self.nats[kind + "_bytes_in"] += bytes_in * messages_in
            self.nats[kind + "_bytes_out"] += bytes_in * receivers
            self.nats["messages_in"] += messages_in
            self.nats["messages_out"] += receivers
            self.nats_cpu_s += cpu_s
        done_s = self.router.do(self.queue.now_s, cpu_s * self.s.slowdown)
        return self.nats_link.do(done_s, bytes_in * receivers * self.wire / self.p["nats_link_bit_per_s"])

    def control(self, bytes_count: float, messages_in: float, receivers: float):
        self.route("control", bytes_count, receivers, messages_in)

    def news_of_people(self):
        alive = sum(edge.alive for edge in self.edges)
        self.control(self.p["arrival_bytes"], alive, alive)

    # ---- frames -----------------------------------------------------------------------------------------------------

    def watchers(self, edge: Edge, name: str, number: int | None = None) -> int:
        """Returns how many clients watch the stream, or take its frame of this number."""
        return sum(
            count
            for level, count in edge.clients.items()
            if name in self.level_streams[level] and (number is None or number % self.stride(level, name) == 0)
        )

    def stride(self, level: str, name: str) -> int:
        """A level takes every n-th frame of a stream that it shares with higher levels."""
        return round(self.streams[name]["rate_hz"] / level_rate_hz(self.p, level))

    def make_frame(self, name: str):
        stream = self.streams[name]
        number = self.numbers[name] = self.numbers.get(name, -1) + 1
        if not any(edge.alive and self.watchers(edge, name, number) for edge in self.edges):
            return
        made_s = self.queue.now_s
        asked = self.wanted_keyframes.pop(name, None) if stream["delta_bytes"] > 0 else None
        # A frame with both forms is encoded twice.
        encode_s = stream["encode_s"] * (2 if asked else 1)
        publish_s = self.p["origin_cpu_per_published_frame_s"]
        if self.is_measuring:
            self.origin_cpu_s += encode_s + publish_s
        base_s = log_normal(self.random, self.base_p50_s, self.base_p99_s)
        done_s = self.encoder.do(made_s, encode_s * self.s.slowdown)
        self.queue.at(done_s, lambda: self.publish(name, number, made_s - base_s, bool(asked)))

    def publish(self, name: str, number: int, made_s: float, has_keyframe: bool):
        stream, now_s = self.streams[name], self.queue.now_s
        head, latency_s = self.p["frame_head_bytes"], self.p["network_latency_s"]
        watching = [edge for edge in self.edges if edge.alive and self.watchers(edge, name)]
        if has_keyframe:
            taking = [edge for edge in watching if edge.keyframes_until_s.get(name, -1.0) >= now_s]
            size = head + stream["delta_bytes"] + stream["keyframe_bytes"]
            sent_s = self.route("keyframe", size, len(taking))
            for edge in taking:
                self.queue.at(sent_s + 2 * latency_s, lambda edge=edge: self.receive(edge, name, number, made_s, True))
        size = head + (stream["delta_bytes"] or stream["keyframe_bytes"])
        begin_s = max(self.nats_link.free_at_s, now_s)
        sent_s = self.route("frame", size, len(watching))
        for place, edge in enumerate(watching):
            at_s = begin_s + (sent_s - begin_s) * (place + 1) / len(watching) + 2 * latency_s
            self.queue.at(at_s, lambda edge=edge: self.receive(edge, name, number, made_s, False))

    def receive(self, edge: Edge, name: str, number: int, made_s: float, has_keyframe: bool):
        done_s = self.work(edge, edge.delivery, self.p["edge_cpu_per_frame_received_s"])
        self.queue.at(done_s, lambda: self.send(edge, name, number, made_s, has_keyframe))

    def send(self, edge: Edge, name: str, number: int, made_s: float, has_keyframe: bool):
        """The frame goes to the clients of the edge: a keyframe to those who need one, the delta to the others."""
        if not edge.alive:
            return
        stream, now_s = self.streams[name], self.queue.now_s
        needy = edge.needy.get(name, [])
        if has_keyframe:
            self.transmit(edge, name, stream["keyframe_bytes"], len(needy), made_s)
            for since_s in needy:
                if self.is_measuring:
                    self.first_frames.add(edge.link.free_at_s - since_s)
            edge.needy[name] = []
            return
        count = self.watchers(edge, name, number) - len(needy)
        if count <= 0:
            return
        self.transmit(edge, name, stream["delta_bytes"] or stream["keyframe_bytes"], count, made_s)
        if stream["delta_bytes"] > 0:
            for _ in range(self.draw_losses(count)):
                self.need_keyframe(edge, name, now_s)

    def draw_losses(self, count: int) -> int:
        mean = count * self.p["lost_frame_share"]
        losses, chance = 0, math.exp(-mean)
        left = self.random.random() - chance
        while left > 0.0 and losses < count:
            losses += 1
            chance *= mean / losses
            left -= chance
        return losses

    def transmit(self, edge: Edge, name: str, bytes_count: float, count: int, made_s: float):
        if count == 0:
            return
        each_s = self.p["edge_cpu_per_frame_sent_s"] + bytes_count * self.p["edge_cpu_per_byte_sent_s"]
        wire_each_s = bytes_count * self.wire / self.p["edge_link_bit_per_s"]
        now_s = self.queue.now_s
        begin_s = max(edge.io.free_at_s, now_s)
        self.work(edge, edge.io, count * each_s)
        link_begin_s = max(edge.link.free_at_s, begin_s)
        end_s = edge.link.do(begin_s, count * wire_each_s)
        end_s = edge.link.free_at_s = max(end_s, edge.io.free_at_s)
        self.count_sent(edge, count * bytes_count)
        receiver_s = self.s.receiver_s * self.s.slowdown
        receiver_begin_s = max(self.receiver.free_at_s, now_s) if receiver_s > 0.0 else 0.0
        if receiver_s > 0.0:
            self.receiver.do(now_s, count * receiver_s)
        if not self.is_measuring or not name.startswith("surface"):
            return
        self.surface_frames += count
        slowed_s = each_s * self.s.slowdown
        for k in range(BATCH_SAMPLES):
            place = (k + 0.5) / BATCH_SAMPLES * count
            at_s = min(end_s, max(begin_s + place * slowed_s, link_begin_s + place * wire_each_s))
            at_s = max(at_s, receiver_begin_s + place * receiver_s)
            self.delays.add(at_s - made_s, count / BATCH_SAMPLES)

    # ---- the run ----------------------------------------------------------------------------------------------------

    def run(self) -> dict:
        s, p = self.s, self.p
        if s.arrivals_per_s == 0:
            for k in range(s.clients):
                level, edge = self.draw_level(), self.edges[k % s.edges]
                edge.clients[level] = edge.clients.get(level, 0) + 1
            self.joined = s.clients
        else:
            for k in range(s.clients):
                self.queue.at(k / s.arrivals_per_s, lambda: self.join(self.draw_level()))
        for name, stream in self.streams.items():
            self.queue.every(1.0 / (stream["rate_hz"] * s.rate_factor), 0.0, lambda name=name: self.make_frame(name))
        for edge in self.edges:
            phase_s = self.random.random()
            self.queue.every(p["link_pulse_interval_s"], phase_s * p["link_pulse_interval_s"], self.link_pulse(edge))
        if p["news_messages_per_s"] > 0:
            size = p["news_bytes_per_s"] / p["news_messages_per_s"]
            self.queue.every(1.0 / p["news_messages_per_s"], 0.0, lambda: self.control(size, s.edges, s.edges))
        if s.commands_per_s > 0:
            self.queue.every(1.0 / s.commands_per_s, 0.0, lambda: self.control(p["command_bytes"] / 2, 2, 2))
        begin_s = s.warm_up_s + (s.clients / s.arrivals_per_s if s.arrivals_per_s else 0.0)
        if s.churn_per_s > 0:

            def churn():
                if self.queue.now_s >= begin_s:
                    self.leave()
                    self.join(self.draw_level())

            self.queue.every(1.0 / s.churn_per_s, 0.0, churn)
        self.queue.run_until(begin_s)
        self.is_measuring = True
        if s.edge_death:
            self.kill_edge()
        self.queue.run_until(begin_s + s.measured_s)
        return self.report()

    def link_pulse(self, edge: Edge):
        def pulse():
            if edge.alive:
                self.control(self.p["link_pulse_bytes"], 1, 1)
                self.control(self.p["watching_bytes"], 1, 1)

        return pulse

    def report(self) -> dict:
        p, time_s = self.p, self.s.measured_s
        alive = [edge for edge in self.edges if edge.alive]
        mbit = 8e-6 / time_s
        busiest = max(alive, key=lambda edge: edge.cpu_s)
        bytes_in = sum(value for name, value in self.nats.items() if name.endswith("bytes_in"))
        bytes_out = sum(value for name, value in self.nats.items() if name.endswith("bytes_out"))
        return {
            "clients": self.s.clients,
            "edges": self.s.edges,
            "delay_p50_ms": self.delays.quantile(0.5, 1e3),
            "delay_p99_ms": self.delays.quantile(0.99, 1e3),
            "first_frame_p50_ms": self.first_frames.quantile(0.5, 1e3),
            "first_frame_p99_ms": self.first_frames.quantile(0.99, 1e3),
            "surface_frames_per_client_per_s": self.surface_frames / time_s / max(1, self.s.clients),
            "client_mbit_per_s": mbit * sum(edge.sent_bytes for edge in self.edges),
            "edge_cpu_cores": busiest.cpu_s / time_s + p["edge_idle_cpu"],
            "edges_cpu_cores": sum(e.cpu_s for e in self.edges) / time_s + p["edge_idle_cpu"] * len(alive),
            "edge_backlog_s": max(0.0, max(edge.link.free_at_s for edge in alive) - self.queue.now_s),
            "receiver_backlog_s": max(0.0, self.receiver.free_at_s - self.queue.now_s),
            "edge_mbit_per_s": mbit * max(edge.sent_bytes for edge in alive),
            "edge_memory_mb": 1e-6
            * (p["edge_memory_bytes"] + p["edge_memory_per_client_bytes"] * max(edge.client_count() for edge in alive)),
            "origin_cpu_cores": p["origin_idle_cpu"] * self.s.rate_factor
            + self.origin_cpu_s / time_s
            + p["origin_cpu_per_link_s"] * len(alive),
            "nats_cpu_cores": p["nats_idle_cpu"] + self.nats_cpu_s / time_s,
            "nats_in_mbit_per_s": mbit * bytes_in,
            "nats_out_mbit_per_s": mbit * bytes_out,
            "nats_keyframe_out_mbit_per_s": mbit * self.nats["keyframe_bytes_out"],
            "nats_control_out_mbit_per_s": mbit * self.nats["control_bytes_out"],
            "nats_frame_bytes_in": self.nats["frame_bytes_in"],
            "nats_frame_bytes_out": self.nats["frame_bytes_out"],
            "nats_messages_in_per_s": self.nats["messages_in"] / time_s,
            "nats_messages_out_per_s": self.nats["messages_out"] / time_s,
        }

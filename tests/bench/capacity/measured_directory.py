"""Cost of the directory of rooms, and the time of building a room that was taken over."""
import json
import signal
import statistics
import time

from cluster_processes import Cluster
from nats_client import NatsClient, string_field

BUCKET = "spindrift_rooms"
CHECKS = 2000
CHANGES = 1000
# Watches beside that of the server, for the CPU per change told.
WATCHES = 20
# The accounting of CPU time lags behind.
REST_S = 0.5


class Directory:
    """Asks and writes as a server does, one request after the other."""

    def __init__(self, cluster: Cluster):
        self.nats, self.client = cluster.nats, NatsClient(cluster.url)
        self.inbox = "_INBOX.capacity"
        self.client.subscribe(self.inbox)

    def ask(self, subject: str, payload: bytes = b"") -> tuple[float, bytes]:
        """Returns the time that the answer took, and the answer."""
        begin = time.monotonic()
        self.client.publish(subject, payload, self.inbox)
        for at, received, answer in self.client.listen(5):
            if received == self.inbox:
                return at - begin, answer
        raise RuntimeError(f"the NATS server did not answer {subject} within 5 s")

    def measure(self, count: int, request) -> tuple[float, float]:
        """Returns CPU of the NATS server per request, and the median time of one."""
        time.sleep(REST_S)
        idle_cpu, begin = self.nats.cpu_s(), time.monotonic()
        time.sleep(4 * REST_S)
        idle = (self.nats.cpu_s() - idle_cpu) / (time.monotonic() - begin)
        before, begin = self.nats.cpu_s(), time.monotonic()
        times = [self.ask(*request(k))[0] for k in range(count)]
        time.sleep(REST_S)
        cpu = self.nats.cpu_s() - before - idle * (time.monotonic() - begin)
        return max(0.0, cpu) / count, statistics.median(times)

    def watch(self, count: int):
        """Watches that nobody reads: what they cost the reader is not measured here."""
        for k in range(count):
            config = {"deliver_subject": f"_INBOX.watch{k}", "deliver_policy": "last_per_subject", "ack_policy": "none",
                      "max_deliver": 1, "filter_subject": f"$KV.{BUCKET}.>", "mem_storage": True, "num_replicas": 1}  # fmt: skip
            self.client.subscribe(config["deliver_subject"])
            payload = json.dumps({"stream_name": f"KV_{BUCKET}", "config": config}).encode()
            answer = self.ask(f"$JS.API.CONSUMER.CREATE.KV_{BUCKET}", payload)[1]
            if b'"error"' in answer:
                raise RuntimeError(f"the NATS server made no watch: {answer.decode()}")


def measure_directory(cluster: Cluster) -> dict:
    """One server that watches is there; keys are written that are not names of rooms, so it leaves them alone."""
    cluster.add_server("s1")
    directory = Directory(cluster)

    def change(k: int) -> tuple[str, bytes]:
        return f"$KV.{BUCKET}.not.a.room.{k % 200}", string_field(1, "nobody")

    check_cpu_s, check_s = directory.measure(CHECKS, lambda k: (f"$JS.API.STREAM.INFO.KV_{BUCKET}",))
    few_cpu_s, write_s = directory.measure(CHANGES, change)
    directory.watch(WATCHES)
    many_cpu_s, _ = directory.measure(CHANGES, change)
    directory.client.close()
    told_cpu_s = max(0.0, many_cpu_s - few_cpu_s) / WATCHES
    print(f"  directory: check {1e6 * check_cpu_s:.0f} us of NATS and {1e3 * check_s:.3f} ms, write {1e6 * few_cpu_s:.0f} us with 1 watch, "
          f"{1e6 * many_cpu_s:.0f} us with {WATCHES + 1}", flush=True)  # fmt: skip
    found = {
        "nats_cpu_per_directory_check_s": check_cpu_s,
        "nats_cpu_per_directory_write_s": max(0.0, few_cpu_s - told_cpu_s),
        "nats_cpu_per_directory_change_told_s": told_cpu_s,
        "directory_check_s": check_s,
        "directory_write_s": write_s,
    }
    return {name: float(f"{value:.4g}") for name, value in found.items()}


def measure_builds(cluster: Cluster, deaths: int) -> dict:
    """Kills the server of the room, again and again; a second one takes it each time."""
    runs = cluster.add_server("s1")
    times = []
    for k in range(deaths):
        taker = cluster.add_server(f"s{k + 2}")
        time.sleep(3)
        runs.end(signal.SIGKILL)
        begin = time.monotonic()
        while not (opened := taker.log_times(r"room main runs here now")):
            if time.monotonic() - begin > 30:
                raise RuntimeError("the room was not taken over within 30 s:\n" + taker.log.read_text()[-2000:])
            time.sleep(0.05)
        claimed = taker.log_times(r"room main: taken over from")
        times.append((opened[0][0] - claimed[0][0]) % 86_400)
        print(f"  death {k + 1}: the room runs {times[-1]:.3f} s after its claim", flush=True)
        runs = taker
        time.sleep(1)
    return {"room_build_p50_s": round(statistics.median(times), 3), "room_build_p99_s": round(max(times), 3)}

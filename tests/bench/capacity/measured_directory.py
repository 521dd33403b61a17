"""Cost of the directory of rooms for many rooms, and the time of building a room that was taken over."""
import signal
import statistics
import time

from bus_probe import BusProbe
from cluster_processes import Cluster
from nats_client import PART_HEAD, NatsClient, string_field

BUCKET = "spindrift_rooms"
ROOMS = 200
# Requests of one review follow each other within this time.
PAUSE_S = 0.06


def reviews(requests: list) -> list:
    """Groups requests to the directory into reviews; returns (begin, duration, number of requests) of each whole one."""
    groups = []
    for at, _ in requests:
        if not groups or at - groups[-1][-1] > PAUSE_S:
            groups.append([])
        groups[-1].append(at)
    return [(group[0], group[-1] - group[0], len(group)) for group in groups[1:-1]]


class SilentServer:
    """The pulses and the directory entries of a server that owns many rooms, so that others read a full directory."""

    def __init__(self, client: NatsClient):
        self.client = client

    def enter_rooms(self, count: int) -> list:
        """Writes the entries one after the other; returns the time that each took."""
        inbox = "_INBOX.capacity"
        subscription = self.client.subscribe(inbox)
        times = []
        for k in range(count):
            begin = time.monotonic()
            self.client.publish(f"$KV.{BUCKET}.r{k:04}", string_field(1, "silent"), inbox)
            for at, _, _ in self.client.listen(5):
                times.append(at - begin)
                break
        self.client.unsubscribe(subscription)
        if len(times) != count:
            raise RuntimeError(f"the NATS server acknowledged only {len(times)} of {count} entries of the directory")
        return times

    def stay_alive(self, seconds: float, probe: BusProbe | None = None):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            pulse = PART_HEAD.pack(time.monotonic_ns(), 0, 1) + string_field(1, "silent")
            self.client.publish("spindrift.servers", pulse)
            if probe:
                probe.listen(0.2)
            else:
                time.sleep(0.2)


def measure_directory(cluster: Cluster, seconds: float) -> dict:
    cluster.add_server("s1")
    client = NatsClient(cluster.url)
    listener = NatsClient(cluster.url)
    silent = SilentServer(client)
    silent.stay_alive(2)

    def watch(rooms: int):
        before, begin = cluster.nats.cpu_s(), time.monotonic()
        silent.stay_alive(seconds)
        cpu = (cluster.nats.cpu_s() - before) / (time.monotonic() - begin)
        probe = BusProbe(listener, "spindrift", lambda stream, level: "")
        probe.listen_to_directory()
        silent.stay_alive(seconds, probe)
        probe.end()
        found = reviews(probe.directory_requests)
        if len(found) < 2:
            raise RuntimeError(f"{len(found)} reviews of the directory were seen on $JS.API.> in {seconds} s: give more --seconds")
        duration = statistics.median(one for _, one, _ in found)
        per_s = (len(found) - 1) / (found[-1][0] - found[0][0])
        print(f"  directory of {rooms} rooms: {per_s:.2f} reviews/s of {1e3 * duration:.2f} ms with "
              f"{statistics.median(count for _, _, count in found):.0f} requests, NATS {cpu:.4f} cores", flush=True)  # fmt: skip
        return cpu, duration, per_s

    cpu_one, duration_one, _ = watch(1)
    writes = silent.enter_rooms(ROOMS)
    cpu_all, duration_all, reviews_per_s = watch(ROOMS + 1)
    client.close()
    listener.close()
    per_key_s = max(0.0, duration_all - duration_one) / ROOMS
    return {
        "nats_cpu_per_directory_key_s": float(f"{max(0.0, cpu_all - cpu_one) / (reviews_per_s * ROOMS):.4g}"),
        "directory_read_per_key_s": float(f"{per_key_s:.4g}"),
        "directory_read_s": float(f"{max(0.0, duration_one - per_key_s):.4g}"),
        "directory_write_s": float(f"{statistics.median(writes):.4g}"),
    }


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

"""Starts a NATS server, servers and edges on loopback in a temporary folder, reads what they cost, and ends them."""
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

TICK_S = 1.0 / os.sysconf("SC_CLK_TCK")
PAGE_BYTES = os.sysconf("SC_PAGE_SIZE")


def free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def get(url: str) -> str:
    with urllib.request.urlopen(url, timeout=5) as answer:
        return answer.read().decode()


class Process:
    def __init__(self, name: str, command: list[str], folder: pathlib.Path, port: int = 0):
        self.name, self.port = name, port
        self.log = folder / f"{name}.log"
        with self.log.open("ab") as out:
            self.child = subprocess.Popen(command, stdout=out, stderr=out, cwd=folder, stdin=subprocess.DEVNULL)

    def cpu_s(self) -> float:
        return cpu_of(f"/proc/{self.child.pid}/stat")

    def thread_cpu_s(self) -> dict:
        out = {}
        for task in pathlib.Path(f"/proc/{self.child.pid}/task").iterdir():
            try:
                out[task.name] = cpu_of(f"{task}/stat")
            except OSError:  # the thread ended meanwhile
                continue
        return out

    def memory_bytes(self) -> int:
        return int(pathlib.Path(f"/proc/{self.child.pid}/statm").read_text().split()[1]) * PAGE_BYTES

    def metrics(self) -> dict:
        """Sums over labels by name, and each sample by its name with labels."""
        out = {}
        for line in get(f"http://127.0.0.1:{self.port}/metrics").splitlines():
            if line.startswith("#"):
                continue
            key, _, value = line.rpartition(" ")
            out[key] = float(value)
            name = key.partition("{")[0]
            if name != key:
                out[name] = out.get(name, 0.0) + float(value)
        return out

    def log_times(self, pattern: str) -> list:
        """Returns (seconds of the day, match) of the lines of the log that match."""
        out = []
        for line in self.log.read_text(encoding="utf-8", errors="replace").splitlines():
            clock = re.match(r"(\d\d):(\d\d):(\d\d\.\d+) ", line)
            if clock and (found := re.search(pattern, line)):
                out.append((int(clock[1]) * 3600 + int(clock[2]) * 60 + float(clock[3]), found))
        return out

    def wait_for(self, path: str, seconds: float = 60.0):
        """Waits until the URL path answers 200."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if self.child.poll() is not None:
                break
            try:
                get(f"http://127.0.0.1:{self.port}{path}")
                return
            except (urllib.error.URLError, OSError):
                time.sleep(0.05)
        text = self.log.read_text(encoding="utf-8", errors="replace")[-2000:]
        raise RuntimeError(f"{self.name} was not ready within {seconds} s:\n{text}")

    def end(self, how=signal.SIGTERM):
        if self.child.poll() is None:
            self.child.send_signal(how)
        try:
            self.child.wait(10)
        except subprocess.TimeoutExpired:
            self.child.kill()
            self.child.wait()


def cpu_of(path: str) -> float:
    after_name = pathlib.Path(path).read_text().rpartition(")")[2].split()
    return (int(after_name[11]) + int(after_name[12])) * TICK_S


def machine_cpu_s() -> float:
    """Returns the time that all CPUs together were busy, with what the host of a virtual machine took from them."""
    user, nice, system, _, _, interrupt, soft, steal = map(int, pathlib.Path("/proc/stat").read_text().split()[1:9])
    return (user + nice + system + interrupt + soft + steal) * TICK_S


class Cluster:
    """Use it with `with`: everything that it started is ended, and its folder is removed."""

    def __init__(self, program: str, scene: str):
        self.program, self.scene = program, scene
        self.servers, self.edges = {}, {}

    def __enter__(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="spindrift-capacity-"))
        try:
            port, self.monitor_port = free_port(), free_port()
            self.url = f"nats://127.0.0.1:{port}"
            nats = shutil.which("nats-server", path=os.environ["PATH"] + ":/usr/sbin:/usr/local/sbin")
            if not nats:
                raise RuntimeError("nats-server is not installed: apt-get install nats-server")
            command = [nats, "-a", "127.0.0.1", "-p", str(port), "-m", str(self.monitor_port), "-js", "-sd", "jetstream"]
            self.nats = Process("nats", command, self.folder, self.monitor_port)
            self.nats.wait_for("/varz", 10)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for process in [*self.edges.values(), *self.servers.values()]:
            process.end()
        if hasattr(self, "nats"):
            self.nats.end()
        shutil.rmtree(self.folder, ignore_errors=True)

    def add_server(self, name: str, *options: str) -> Process:
        port = free_port()
        command = [self.program, "serve", "--nats", self.url, "--node", name, "--state-dir", str(self.folder / "state"),
                   "--scene", self.scene, "--port", str(port), "--max-sessions", "2000", "--address-share", "1", *options]  # fmt: skip
        self.servers[name] = Process(name, command, self.folder, port)
        self.servers[name].wait_for("/metrics")
        return self.servers[name]

    def add_edge(self, name: str) -> Process:
        port = free_port()
        command = [self.program, "edge", "--nats", self.url, "--node", name, "--port", str(port),
                   "--max-sessions", "4000", "--address-share", "1"]  # fmt: skip
        self.edges[name] = Process(name, command, self.folder, port)
        self.edges[name].wait_for("/metrics")
        return self.edges[name]

    def nats_totals(self) -> dict:
        values = json.loads(get(f"http://127.0.0.1:{self.monitor_port}/varz"))
        return {name: values[name] for name in ("in_msgs", "out_msgs", "in_bytes", "out_bytes", "mem")}

    def start_load(self, edges: list, clients: int, level: str, seconds: float, commands_per_s: float) -> Process:
        urls = [part for edge in edges for part in ("--url", f"ws://127.0.0.1:{edge.port}/ws")]
        command = [self.program + "-bench", "--suite", "load", *urls, "--clients", str(clients), "--level", level,
                   "--seconds", str(seconds), "--commands-per-s", str(commands_per_s), "--json", "load.json"]  # fmt: skip
        (self.folder / "load.json").unlink(missing_ok=True)
        return Process("load", command, self.folder)

    def load_result(self, load: Process) -> dict:
        if load.child.wait(120) != 0:
            raise RuntimeError("the load bench failed:\n" + load.log.read_text()[-2000:])
        return json.loads((self.folder / "load.json").read_text())

"""What operators do to a running cluster over REST: rooms come and go, parameters and scenes change."""
import collections
import json
import random
import threading
import time
import urllib.error
import urllib.request

ROOMS = ("extra0", "extra1")
ROOM_SCENE = "splash_wave"
OTHER_SCENES = ("boat_wake_wave", "rain_rings")
# Live parameters of the scene and their ranges; a scene without one answers with a rejection.
PARAMETERS = {"wave.damping_per_s": (0.1, 0.2), "particles.viscosity_pas": (50.0, 70.0)}
STAY_S = 20.0  # of an additional room, and of another scene
AFTERMATH_S = 10.0  # after which the process is as before
# The allocator's heap grows with the first dozens of rooms and scenes and stays so: the warm-up has as many of each.
WARM_UP_COUNT = 20
WARM_UP_STAY_S = 2.0


class Disturber(threading.Thread):
    """Runs until stop(); `ports` are those of servers and edges, which are asked in turn."""

    def __init__(self, ports: list[int], scene: str, intervals_s: dict, warm_up_s: float, seed: int):
        super().__init__(daemon=True)
        self.ports, self.scene, self.intervals_s = ports, scene, intervals_s
        self.warm_up_s, self.warm_at = warm_up_s, time.monotonic() + warm_up_s
        self.random = random.Random(seed)
        self.answers = collections.Counter()  # (what, HTTP status): number
        self.ended = threading.Event()
        self.command_id = 0
        self.calm_at = 0.0
        self.error = None

    def stop(self):
        self.ended.set()
        self.join(60)

    def is_calm(self) -> bool:
        """Whether there is only the scene that there was at the start, and no other since a while."""
        return time.monotonic() >= self.calm_at

    def run(self):
        try:
            due = {name: time.monotonic() + self.interval_s(name) for name in self.intervals_s}
            while not self.ended.wait(0.5):
                for name in due:
                    if time.monotonic() >= due[name]:
                        getattr(self, name)()
                        due[name] = time.monotonic() + self.interval_s(name)
        except OSError as error:
            self.error = error

    def interval_s(self, name: str) -> float:
        is_warm = time.monotonic() >= self.warm_at
        return self.intervals_s[name] if is_warm else min(self.intervals_s[name], self.warm_up_s / WARM_UP_COUNT)

    def stay(self):
        self.ended.wait(STAY_S if time.monotonic() >= self.warm_at else WARM_UP_STAY_S)

    def parameter(self):
        path = self.random.choice(list(PARAMETERS))
        self.command("parameter", {"set_parameter": {"path": path, "value": self.random.uniform(*PARAMETERS[path])}})

    def room(self):
        self.calm_at = float("inf")
        name = self.random.choice(ROOMS)
        self.ask("open room", "POST", "/api/v1/rooms", {"name": name, "scene": ROOM_SCENE})
        self.stay()
        self.ask("close room", "DELETE", f"/api/v1/rooms/{name}")
        self.calm_at = time.monotonic() + AFTERMATH_S

    def change_scene(self):
        self.calm_at = float("inf")
        self.command("other scene", {"change_scene": {"name": self.random.choice(OTHER_SCENES)}})
        self.stay()
        # A room changes its scene at most once in a few seconds.
        while self.command("first scene", {"change_scene": {"name": self.scene}}) != 200 and not self.ended.wait(2.0):
            pass
        self.calm_at = time.monotonic() + AFTERMATH_S

    def command(self, what: str, action: dict) -> int:
        self.command_id += 1
        return self.ask(what, "POST", "/api/v1/rooms/main/commands", {"command_id": self.command_id} | action)

    def ask(self, what: str, method: str, path: str, body: dict | None = None) -> int:
        port = self.random.choice(self.ports)
        content = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(f"http://127.0.0.1:{port}{path}", content, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                status = answer.status
        except urllib.error.HTTPError as refusal:
            status = refusal.code
        self.answers[what, status] += 1
        return status

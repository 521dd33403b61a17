"""What a cluster says on the bus: sizes of frames by stream and level, and of control messages by their kind."""
import base64
import os
import socket
import statistics
import time

from nats_client import FRAME_HEAD, PART_HEAD, NatsClient, fields

# Numbers of the members of the oneofs in proto/spindrift/v1/cluster.proto.
TO_ROOM = {3: "attach", 4: "watching", 5: "arrive", 6: "leave", 7: "command", 8: "detach"}
FROM_ROOM = {4: "view", 5: "news", 6: "admitted", 7: "outcome", 10: "link_pulse", 14: "closed", 12: "reduced"}


class BusProbe:
    """Collects while it listens; `name_of(stream, level)` gives the name of a stream of frames."""

    def __init__(self, client: NatsClient, cluster: str, name_of):
        self.client, self.cluster, self.name_of = client, cluster, name_of
        self.deltas, self.keyframes, self.counts = {}, {}, {}
        self.control = {}  # sizes by kind
        self.loads = {}  # by server: shares of the busy simulation thread
        self.seconds = 0.0
        self.subscriptions = [client.subscribe(f"{cluster}.>")]

    def listen(self, seconds: float):
        begin = time.monotonic()
        for _, subject, payload in self.client.listen(seconds):
            if len(payload) >= PART_HEAD.size:
                self.take(subject.split(".")[1:], payload)
        self.seconds += time.monotonic() - begin

    def take(self, subject: list, payload: bytes):
        body = payload[PART_HEAD.size :]
        if subject[0] == "frames":
            name = self.name_of(int(subject[2]), subject[3])
            keyframe_bytes, delta_bytes = FRAME_HEAD.unpack_from(body)[-2:]
            if keyframe_bytes:
                self.keyframes.setdefault(name, []).append(keyframe_bytes)
            if len(subject) > 4:
                return  # the same frame comes without its keyframe as well
            self.counts[name] = self.counts.get(name, 0) + 1
            if delta_bytes:
                self.deltas.setdefault(name, []).append(delta_bytes)
        elif subject[0] == "room":
            self.note(TO_ROOM, fields(body), len(payload))
        elif subject[0] == "node":
            message = fields(body).get(1)
            if isinstance(message, bytes):
                self.note(FROM_ROOM, fields(message), len(payload))
        elif subject[0] == "servers":
            pulse = fields(body)
            self.loads.setdefault(pulse[1].decode(), []).append(pulse.get(3, 0.0))
            self.control.setdefault("server_pulse", []).append(len(payload))

    def note(self, kinds: dict, message: dict, size: int):
        for number, kind in kinds.items():
            if number in message:
                self.control.setdefault(kind, []).append(size)

    def end(self):
        for subscription in self.subscriptions:
            self.client.unsubscribe(subscription)

    def mean(self, kind: str) -> float | None:
        return statistics.mean(self.control[kind]) if self.control.get(kind) else None


def greeting_bytes(port: int, seconds: float = 1.0) -> int:
    """Connects to an edge as a client does, says hello, watches nothing, and counts what comes."""
    with socket.create_connection(("127.0.0.1", port), timeout=5) as one:
        key = base64.b64encode(os.urandom(16)).decode()
        one.sendall(
            f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: spindrift.v1\r\n\r\n".encode()
        )
        answer = b""
        while b"\r\n\r\n" not in answer:
            answer += one.recv(65536)
        if b" 101 " not in answer.partition(b"\r\n")[0]:
            raise RuntimeError("the edge refused a client: " + answer.decode(errors="replace")[:200])
        hello = bytes([0x0A, 6, 0x0A, 4, 0x08, 1, 0x10, 1])  # hello { version { major: 1 minor: 1 } }
        mask = os.urandom(4)
        one.sendall(bytes([0x82, 0x80 | len(hello)]) + mask + bytes(b ^ mask[k % 4] for k, b in enumerate(hello)))
        count = len(answer.partition(b"\r\n\r\n")[2])
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            one.settimeout(left)
            try:
                data = one.recv(65536)
            except TimeoutError:
                break
            if not data:
                raise RuntimeError("the edge closed the connection of a client that had said hello")
            count += len(data)
        return count

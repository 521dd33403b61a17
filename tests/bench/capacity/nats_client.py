"""A small NATS client that listens to a cluster, and the parts of its messages that the measurement needs."""
import json
import socket
import struct
import time
import urllib.parse

PART_HEAD = struct.Struct("<QII")  # number of the message, of the part, of parts
# mark, run, sequence, reduced count, levels that take it, bytes of the keyframe, bytes of the delta
FRAME_HEAD = struct.Struct("<IQQHHII")


class NatsClient:
    def __init__(self, url: str):
        place = urllib.parse.urlsplit(url)
        self.socket = socket.create_connection((place.hostname, place.port), timeout=5)
        self.bytes = b""
        self.line()  # INFO
        self.subscriptions = 0
        self.write(b"CONNECT " + json.dumps({"verbose": False, "lang": "python", "version": "0"}).encode() + b"\r\n")

    def write(self, data: bytes):
        self.socket.sendall(data)

    def more(self):
        data = self.socket.recv(1 << 20)
        if not data:
            raise ConnectionError("the NATS server closed the connection")
        self.bytes += data

    def line(self) -> bytes:
        while b"\r\n" not in self.bytes:
            self.more()
        line, _, self.bytes = self.bytes.partition(b"\r\n")
        return line

    def subscribe(self, subject: str) -> int:
        self.subscriptions += 1
        self.write(f"SUB {subject} {self.subscriptions}\r\n".encode())
        return self.subscriptions

    def unsubscribe(self, subscription: int):
        self.write(f"UNSUB {subscription}\r\n".encode())

    def publish(self, subject: str, payload: bytes, reply: str = ""):
        self.write(f"PUB {subject} {reply} {len(payload)}\r\n".encode() + payload + b"\r\n")

    def listen(self, seconds: float, enough=None):
        """Yields (time, subject, payload) as they come, for so long or until enough() is true."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0 and not (enough and enough()):
            self.socket.settimeout(max(left, 1e-3))
            try:
                words = self.line().decode().split()
                if words[0] == "PING":
                    self.write(b"PONG\r\n")
                elif words[0] == "MSG":
                    size = int(words[-1])
                    self.socket.settimeout(5)
                    while len(self.bytes) < size + 2:
                        self.more()
                    payload, self.bytes = self.bytes[:size], self.bytes[size + 2 :]
                    yield time.monotonic(), words[1], payload
                elif words[0] == "-ERR":
                    raise ConnectionError(" ".join(words))
            except TimeoutError:
                return

    def close(self):
        self.socket.close()


def varint(data: bytes, at: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        value |= (data[at] & 0x7F) << shift
        shift += 7
        at += 1
        if data[at - 1] < 0x80:
            return value, at


def fields(message: bytes) -> dict:
    """Returns the last value of each field of a protobuf message: a number, or bytes."""
    out, at = {}, 0
    while at < len(message):
        key, at = varint(message, at)
        if key & 7 == 0:
            value, at = varint(message, at)
        elif key & 7 == 1:
            value, at = struct.unpack_from("<d", message, at)[0], at + 8
        elif key & 7 == 5:
            value, at = struct.unpack_from("<f", message, at)[0], at + 4
        else:
            size, at = varint(message, at)
            value, at = message[at : at + size], at + size
        out[key >> 3] = value
    return out


def string_field(number: int, text: str) -> bytes:
    return bytes([number << 3 | 2, len(text)]) + text.encode()

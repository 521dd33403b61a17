"""Addresses: what people type or copy from the page, and what sockets and requests need."""
from __future__ import annotations

from dataclasses import dataclass
from urllib.parse import parse_qs, quote, urlsplit


@dataclass(frozen=True)
class Address:
    """`origin`: "http://host:8080", or https; `path`: of a server behind another one, without a slash at its end."""

    origin: str
    path: str
    room: str
    token: str

    @property
    def socket(self) -> str:
        return f"ws{self.origin.removeprefix('http')}{self.path}/ws" + (f"/{quote(self.room, safe='')}" if self.room else "")

    def rest(self, path: str) -> str:
        return f"{self.origin}{self.path}/api/v1/{path}"

    def moved(self, origin: str) -> "Address":
        """The same room at `origin`, "ws://host[:port]" or wss, as Draining.go_to says it."""
        return Address("http" + origin.removeprefix("ws").rstrip("/"), self.path, self.room, self.token)


def parse(url: str, room: str = "", token: str = "") -> Address:
    """Takes "host:port", http, https, ws and wss addresses, and the page's own ("http://host:8080/?room=b#token=t"). `room` and
    `token` come before those of the address. Raises ValueError."""
    parts = urlsplit(url if "://" in url else f"http://{url}")
    scheme = {"http": "http", "ws": "http", "https": "https", "wss": "https"}.get(parts.scheme)
    if scheme is None or not parts.hostname:
        raise ValueError(f"{url!r} is not the address of a server, which looks like http://host:8080 or wss://host")
    path, _, named = parts.path.partition("/ws")
    found = parse_qs(parts.query).get("room", [named.strip("/")])[0]
    kept = parse_qs(parts.fragment).get("token", [""])[0]
    return Address(f"{scheme}://{parts.netloc}", path.rstrip("/"), room or found, token or kept)

"""One room over one WebSocket at a time: hello, subscriptions, answers, and connecting again after a loss."""
from __future__ import annotations

import asyncio
import contextlib
import random
from dataclasses import dataclass
from importlib import metadata
from typing import Any

import websockets
from google.protobuf.message import DecodeError

from . import address
from .errors import ConnectionLost, Damaged, Refused, Rejected, SpindriftError
from .frames import LAYERS, FrameReader
from .hulls import HullForces
from .inbox import Inbox
from .queries import Answer
from .v1 import wire_pb2 as wire

WIRE_VERSION = (1, 11)
"""What this client speaks: major, minor."""
_SUBPROTOCOL = "spindrift.v1"
_MAX_MESSAGE_BYTES = 64 * 1024 * 1024
MAX_WAITING_FRAMES = 16
_MAX_WAITING_EVENTS = 256
_FINAL_CODES = (1002, 1003, 1007, 1008, 4401, 4404, 4409)
"""Close codes after which connecting again does not help."""
_PAUSE_S = (0.5, 8.0)
"""First and longest pause between attempts to connect."""
_SETTLED_S = 5.0
"""A connection that lasted so long is followed by the shortest pause."""


@dataclass(frozen=True)
class Event:
    """Something that happened. `kind`: "live" (connected, `message` is the Welcome), "lost" (it connects again by itself), "moving" (the
    server ends soon, and the client connects again when it is told to), or the name of a message of the server: "greeting"
    (another scene), "room_state", "room_event", "people", "boat_list", "parameter_changed", "level_changed", "lesson", "game",
    "strokes"."""

    kind: str
    text: str = ""
    message: Any = None


class _Closed(Exception):
    """The socket closed."""

    def __init__(self, code: int, text: str):
        super().__init__(text)
        self.code = code


class Session:
    """The connection of a Water: see aio.Water."""

    def __init__(self, url: str, *, room: str = "", name: str = "", token: str = "", client: str = "", patience_s: float = 10.0,
                 answer_within_s: float = 10.0):
        self._address = address.parse(url, room, token)
        self._name, self._client = name, client or f"spindrift-python {_version()}"
        self._patience_s, self._answer_within_s = patience_s, answer_within_s
        self._resume_key = ""
        self._socket = None
        self._task: asyncio.Task | None = None
        self._first = asyncio.get_running_loop().create_future()
        self._subscriptions: dict[str, wire.Subscribe] = {}
        self._inboxes: dict[str, Inbox] = {}
        self._events = Inbox(_MAX_WAITING_EVENTS)
        self._reader = FrameReader()
        self._answers: dict[int, asyncio.Future] = {}
        self._next_command_id = 1
        self._queries: dict[int, Inbox] = {}
        self._next_query_id = 1
        self._hull_forces = Inbox(MAX_WAITING_FRAMES)
        self._move: tuple[float, str] | None = None
        self._failure: SpindriftError | None = None
        self.greeting: wire.Greeting | None = None
        """Scene, limits, device and version of the server, as it greeted last."""
        self.welcome: wire.Welcome | None = None
        """Role and id of this client."""
        self.people: list = []
        self.boats: list = []
        """wire.BoatInfo of every boat: sizes; the layer "bodies" has where they are."""
        self.room_state: wire.RoomState | None = None
        self.lesson: wire.Lesson | None = None
        self.game: wire.Game | None = None
        self.damaged_count = 0
        """Frames that could not be read."""

    # ---- begin and end

    async def __aenter__(self) -> "Session":
        self._task = asyncio.get_running_loop().create_task(self._run())
        try:
            await asyncio.shield(self._first)
        except BaseException:
            await self.close()
            raise
        return self

    async def __aexit__(self, *_):
        await self.close()

    async def close(self):
        """Leaves the room. The server gives the boats back after its grace time."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)
        self._end(ConnectionLost("this client was closed"))

    @property
    def is_live(self) -> bool:
        return self._socket is not None and self.welcome is not None

    def _query_answer(self, answer):
        for result in answer.results:
            inbox = self._queries.get(result.query_id)
            if inbox is None:
                continue
            if result.ended:
                inbox.fail(SpindriftError(f"the query has ended: {result.ended}"))
                del self._queries[result.query_id]
            else:
                inbox.put(Answer.of(answer, result))

    # ---- the connection

    async def _run(self):
        loop = asyncio.get_running_loop()
        begun, failed = loop.time(), 0
        while True:
            started = loop.time()
            try:
                await self._talk()
            except asyncio.CancelledError:
                raise
            except Refused as error:
                return self._end(error)
            except _Closed as closed:
                if closed.code in _FINAL_CODES:
                    return self._end(Refused(str(closed), closed.code))
                why = str(closed)
            except Exception as error:  # pylint: disable=broad-except; whatever breaks it, the connection is made anew
                why = f"{type(error).__name__}: {error}"
            was_live, self._socket, self.welcome = self.welcome is not None, None, None
            self._fail_answers(ConnectionLost(f"the connection was lost ({why}); the command may or may not have been carried out"))
            if not was_live and not self._first.done() and loop.time() - begun > self._patience_s:
                return self._end(ConnectionLost(f"no connection to {self._address.socket} within {self._patience_s:g} s: {why}"))
            if was_live:
                self._events.put(Event("lost", why))
            failed = 1 if was_live and loop.time() - started > _SETTLED_S else failed + 1
            pause_s = min(_PAUSE_S[0] * 2 ** min(failed - 1, 10), _PAUSE_S[1]) * random.uniform(0.75, 1.25)
            if self._move:
                at, origin = self._move
                pause_s = max(at - loop.time(), 0.0)
                self._address = self._address.moved(origin) if origin else self._address
                self._move = None
            await asyncio.sleep(pause_s)

    async def _talk(self):
        """One connection, until it ends, always by an exception."""
        try:
            socket = await websockets.connect(self._address.socket, subprotocols=[_SUBPROTOCOL], max_size=_MAX_MESSAGE_BYTES, open_timeout=10)
        except websockets.InvalidHandshake as error:
            status = getattr(error, "status_code", None) or getattr(getattr(error, "response", None), "status_code", 0)
            if status in (400, 401, 403, 404):
                raise Refused(f"{self._address.socket}: refused with HTTP {status}" + (": there is no such room" if status == 404 else "")) from error
            raise
        self._socket = socket
        mover = None
        try:
            await self._send(hello=wire.Hello(version=wire.Version(major=WIRE_VERSION[0], minor=WIRE_VERSION[1]), client=self._client,
                                              token=self._address.token, name=self._name, resume_key=self._resume_key))
            async for data in socket:
                await self._receive(data)
                if self._move and mover is None:
                    mover = asyncio.get_running_loop().call_at(self._move[0], lambda: asyncio.ensure_future(socket.close()))
            raise _Closed(socket.close_code or 1006, socket.close_reason or f"closed with code {socket.close_code or 1006}")
        except websockets.ConnectionClosed as error:
            raise _Closed(socket.close_code or 1006, socket.close_reason or str(error)) from error
        finally:
            if mover:
                mover.cancel()
            await socket.close()

    async def _receive(self, data):
        message = wire.ServerMessage()
        try:
            if isinstance(data, str):
                raise DecodeError("a text message")
            message.ParseFromString(data)
        except DecodeError:
            self.damaged_count += 1
            return
        kind = message.WhichOneof("message")
        if kind is None:
            return
        body = getattr(message, kind)
        if kind == "frame":
            await self._frame(body)
        elif kind == "diagnostics":
            self._put("diagnostics", body)
        elif kind == "query_answer":
            self._query_answer(body)
        elif kind == "hull_forces":
            self._hull_forces.put(HullForces.of(body))
        elif kind in ("ack", "reject"):
            self._answer(kind, body)
        elif kind == "refusal":
            raise Refused(body.message)
        elif kind == "draining":
            now = asyncio.get_running_loop().time()
            self._move = (now + random.uniform(body.reconnect_after_min_s, body.reconnect_after_max_s), body.go_to)
            self._events.put(Event("moving", f"the server ends within {body.closes_in_s:g} s", body))
        elif kind != "pong":
            await self._news(kind, body)

    async def _news(self, kind, body):
        if kind == "greeting":
            if body.version.major != WIRE_VERSION[0]:
                raise Refused(f"the server speaks {body.version.major}.{body.version.minor} of the wire, this client {WIRE_VERSION[0]}.{WIRE_VERSION[1]}: "
                              "update the older one")
            self.greeting, self.boats, self.room_state = body, list(body.boat_list.boats), body.room_state
        elif kind == "welcome":
            self.welcome, self._resume_key = body, body.resume_key
            for layer in self._subscriptions:
                await self._subscribe(layer)
            if not self._first.done():
                self._first.set_result(None)
            return self._events.put(Event("live", "connected", body))
        elif kind == "people":
            self.people = list(body.people)
        elif kind == "boat_list":
            self.boats = list(body.boats)
        elif kind == "parameter_changed":
            for each in self.greeting.parameters:
                if each.path == body.path:
                    each.value = body.value
        elif kind in ("room_state", "lesson", "game"):
            setattr(self, kind, body)
        self._events.put(Event(kind, getattr(body, "message", ""), body))

    async def _frame(self, frame: wire.LayerFrame):
        layer = wire.Layer.Name(frame.layer).removeprefix("LAYER_").lower() if frame.layer in wire.Layer.values() else ""
        if layer not in self._subscriptions:
            return
        try:
            self._put(layer, self._reader.read(frame))
        except Damaged:
            self.damaged_count += 1
            await self._subscribe(layer)

    def _put(self, layer, item):
        if layer in self._inboxes:
            self._inboxes[layer].put(item)

    def _answer(self, kind, body):
        answer = self._answers.get(body.command_id)
        if answer is None or answer.done():
            return
        if kind == "ack":
            answer.set_result(body)
        else:
            answer.set_exception(Rejected(wire.RejectReason.Name(body.reason).removeprefix("REJECT_REASON_"), body.field, body.message))

    async def _subscribe(self, layer):
        self._reader.forget(LAYERS[layer])
        with contextlib.suppress(websockets.ConnectionClosed):  # after which all subscriptions are made anew
            await self._send(subscribe=self._subscriptions[layer])

    async def _send(self, **message):
        await self._socket.send(wire.ClientMessage(**message).SerializeToString())

    def _fail_answers(self, error):
        for inbox in self._queries.values():
            inbox.fail(error)
        self._queries.clear()
        lost, self._hull_forces = self._hull_forces, Inbox(MAX_WAITING_FRAMES)
        self._hull_forces.dropped = lost.dropped
        lost.fail(error)
        for answer in self._answers.values():
            if not answer.done():
                answer.set_exception(error)

    def _end(self, error: SpindriftError):
        """For good: everybody who waits gets the error."""
        if self._failure:
            return
        self._failure, self._socket, self.welcome = error, None, None
        self._fail_answers(error)
        for inbox in (*self._inboxes.values(), self._events, self._hull_forces):
            inbox.fail(error)
        if not self._first.done():
            self._first.set_exception(error)


def _version():
    try:
        return metadata.version("spindrift-client")
    except metadata.PackageNotFoundError:
        return "from a checkout"

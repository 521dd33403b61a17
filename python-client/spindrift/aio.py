"""A room for asyncio: `async with connect("http://localhost:8080") as water: ...`"""
from __future__ import annotations

import asyncio
import contextlib
import json
import random
import urllib.error
import urllib.request
from dataclasses import dataclass
from importlib import metadata
from typing import Any, AsyncIterator

import websockets
from google.protobuf import json_format
from google.protobuf.message import DecodeError

from . import address, commands, queries
from .clock import Clock
from .errors import ConnectionLost, Damaged, NoAnswer, Refused, Rejected, SpindriftError
from .frames import LAYERS, Boats, Floaters, Foam, Frame, FrameReader, Particles, Surface
from .gauges import GaugeSeries
from .hulls import HullForces
from .inbox import Inbox
from .queries import Answer
from .v1 import api_pb2 as api
from .v1 import wire_pb2 as wire

WIRE_VERSION = (1, 11)
"""What this client speaks: major, minor."""
_SUBPROTOCOL = "spindrift.v1"
_MAX_MESSAGE_BYTES = 64 * 1024 * 1024
_MAX_WAITING_COMMANDS = 64
_MAX_WAITING_FRAMES = 16
_MAX_WAITING_EVENTS = 256
_MAX_WAITING_ANSWERS = 64
_SLOW_ACTIONS = ("change_scene", "set_parameter")
"""The server builds water for these, as long as that takes."""
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


@commands.add_methods
class Water:
    """A room of a server. Use `connect`. Connects again by itself, as the same person with the same boats.

    Frames wait in bounded queues, one for each layer: a reader that is too slow loses the oldest, which `dropped` counts. Everything is
    used from one event loop. Methods named like commands of the wire (`splash`, `spawn_boat`, `set_parameter`, ...) take the fields
    of their messages as arguments; help() of each lists them with units and bounds."""

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
        self._hull_forces = Inbox(_MAX_WAITING_FRAMES)
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

    async def __aenter__(self) -> "Water":
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

    # ---- what is known of the room

    @property
    def is_live(self) -> bool:
        return self._socket is not None and self.welcome is not None

    @property
    def role(self) -> str:
        """viewer, player or operator."""
        return wire.Role.Name(self.welcome.role).removeprefix("ROLE_").lower()

    @property
    def scene(self):
        """The scene with its present values (scene.proto)."""
        return self.greeting.scene

    @property
    def parameters(self) -> dict:
        """wire.ParameterDescription by path: label, unit, bounds and present value of what set_parameter takes."""
        return {each.path: each for each in self.greeting.parameters}

    @property
    def dropped(self) -> dict[str, int]:
        """By layer: frames that were dropped for newer ones because nobody took them in time; "hull_forces" counts those of moved boats."""
        hulls = {"hull_forces": self._hull_forces.dropped} if self._hull_forces.dropped else {}
        return {layer: inbox.dropped for layer, inbox in self._inboxes.items()} | hulls

    # ---- frames

    async def subscribe(self, layer: str, *, rate_hz: float = 60.0, packed: bool = True, level: str = "full", adapts: bool = False):
        """Asks for frames of "surface", "particles", "foam", "bodies", "floaters" or "diagnostics", at most `rate_hz` per second (0 ends
        them). `packed`: a tenth of the bytes, the same values of surfaces and foam, coarser ones of particles. `level`: coarse, medium,
        fine or full. `adapts`: the server may send coarser levels while the connection is slow."""
        if layer not in LAYERS:
            raise ValueError(f"there is no layer {layer!r}; there are {', '.join(LAYERS)}")
        wanted = wire.Subscribe(layer=LAYERS[layer], max_rate_hz=rate_hz, packing=wire.PACKING_PACKED if packed else wire.PACKING_PLAIN,
                                level=wire.Level.Value(f"LEVEL_{level.upper()}"), adapts=adapts)
        self._subscriptions[layer] = wanted
        self._inboxes.setdefault(layer, Inbox(_MAX_WAITING_FRAMES))
        if self._failure:
            raise self._failure
        if self.is_live:
            await self._subscribe(layer)

    async def next(self, layer: str) -> Frame | wire.Diagnostics:
        """The newest frame of a layer that was not returned before; waits for one. Subscribes with the defaults if nobody has."""
        return await (await self._inbox(layer)).newest()

    async def frames(self, layer: str) -> AsyncIterator[Frame]:
        """Every frame of a layer in order, but for those that `dropped` counts."""
        inbox = await self._inbox(layer)
        while True:
            yield await inbox.first()

    async def surface(self) -> Surface:
        """next("surface")"""
        return await self.next("surface")

    async def particles(self) -> Particles:
        """next("particles")"""
        return await self.next("particles")

    async def foam(self) -> Foam:
        """next("foam")"""
        return await self.next("foam")

    async def bodies(self) -> Boats:
        """next("bodies")"""
        return await self.next("bodies")

    async def floaters(self) -> Floaters:
        """next("floaters")"""
        return await self.next("floaters")

    async def surface_at(self, tick: int) -> Surface:
        """The first surface of `tick` or later."""
        while (frame := await self.surface()).tick < tick:
            pass
        return frame

    async def events(self) -> AsyncIterator[Event]:
        """What happens, from the beginning on; at most 256 wait."""
        while True:
            yield await self._events.first()

    # ---- commands and requests

    async def command(self, action: str, **fields) -> wire.Ack:
        """Sends a command and waits for its answer. Raises Rejected, ConnectionLost, NoAnswer, and TypeError for fields that the command
        does not have. At most 64 wait at a time."""
        if self._failure:
            raise self._failure
        command = commands.build(action, fields)
        if not self.is_live:
            raise ConnectionLost("not connected at present: the command was not sent")
        if len(self._answers) >= _MAX_WAITING_COMMANDS:
            raise SpindriftError(f"{_MAX_WAITING_COMMANDS} commands wait for their answers: the command was not sent")
        command.command_id, self._next_command_id = self._next_command_id, self._next_command_id + 1
        answer = self._answers[command.command_id] = asyncio.get_running_loop().create_future()
        try:
            await self._send(command=command)
            is_slow = action in _SLOW_ACTIONS or command.step.waits
            return await asyncio.wait_for(answer, None if is_slow else self._answer_within_s)
        except asyncio.TimeoutError:
            raise NoAnswer(f"no answer to {action} within {self._answer_within_s:g} s; it may still be carried out") from None
        except websockets.ConnectionClosed:
            raise ConnectionLost(f"the connection was lost; {action} may or may not have been carried out") from None
        finally:
            self._answers.pop(command.command_id, None)

    def clock(self, *, speed: float = 0.0, timeout_s: float = 10.0) -> Clock:
        """Holds the room's clock: `async with water.clock() as clock: await clock.step(60)`. `speed`: simulated seconds per second of the
        steps, 0: as fast as the machine can. `timeout_s`: a holder who sends no step for so long, while the room waits for it, loses the
        clock."""
        return Clock(self, speed, timeout_s)

    async def advance(self, tick_count: int) -> Surface:
        """Advances a paused room by so many ticks and returns the surface after the last of them."""
        end = (await self.step(tick_count=min(tick_count, 600))).applied_tick
        for begun in range(600, tick_count, 600):
            await self.surface_at(end + 600)
            end = (await self.step(tick_count=min(tick_count - begun, 600))).applied_tick
        return await self.surface_at(end + (tick_count - 1) % 600 + 1)

    async def gauge(self, name: str) -> GaugeSeries:
        """What a gauge measured at the last 4,096 ticks."""
        return GaugeSeries.of(await self.request(f"gauges/{name}", api.GaugeSeries()))

    async def request(self, path: str, message):
        """GET /api/v1/rooms/ROOM/`path` into a message of api.proto. Raises SpindriftError with the server's reason."""
        room = self.greeting.room
        text = await asyncio.get_running_loop().run_in_executor(None, _fetch, self._address.rest(f"rooms/{room}/{path}"), self._address.token)
        return json_format.Parse(text, message, ignore_unknown_fields=True)

    # ---- the water at points

    async def query(self, points, *, velocities=None) -> Answer:
        """The water at `points` ([count, 2]: x and z in metres) now, as one Answer of arrays. At most 1,024 points per client; points
        outside of the water are marked. `velocities` count in streams only. Raises what commands raise, and ValueError for shapes."""
        async with self._asked(queries.fields(points, velocities), 0) as inbox:
            try:
                return await asyncio.wait_for(inbox.first(), self._answer_within_s)
            except asyncio.TimeoutError:
                raise NoAnswer(f"the water at the points did not come within {self._answer_within_s:g} s") from None

    async def stream_query(self, points, *, velocities=None, interval_ticks: int = 1) -> AsyncIterator[Answer]:
        """An Answer now, and one whenever `interval_ticks` have passed, until the iteration ends. `velocities` ([2] for all points, or
        [count, 2], m/s): the points move with them. At most 64 answers wait, the oldest are dropped, and their ticks show it. Raises
        ConnectionLost when the connection is lost, and SpindriftError when the scene changes: ask again then."""
        async with self._asked(queries.fields(points, velocities), interval_ticks) as inbox:
            while True:
                yield await inbox.first()

    @contextlib.asynccontextmanager
    async def _asked(self, fields, interval_ticks):
        query_id, self._next_query_id = self._next_query_id, self._next_query_id % 0xFFFFFFFF + 1
        inbox = self._queries[query_id] = Inbox(_MAX_WAITING_ANSWERS)
        try:
            await self.command("query", query_id=query_id, interval_ticks=interval_ticks, **fields)
            yield inbox
        finally:
            if self._queries.pop(query_id, None) is not None and interval_ticks > 0 and self.is_live:
                with contextlib.suppress(SpindriftError):
                    await self.command("query", query_id=query_id)  # without points: ends the stream

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

    # ---- boats moved from outside

    async def hull_forces(self) -> HullForces:
        """The newest forces on the boats that this client moves (move_boat), that was not returned before; waits for one. Raises
        ConnectionLost when the connection is lost: move the boats again then."""
        return await self._hull_forces.newest()

    async def stream_hull_forces(self) -> AsyncIterator[HullForces]:
        """Those of every tick in order; at most 16 wait, the oldest are dropped, and `dropped` counts them. Raises as hull_forces."""
        inbox = self._hull_forces
        while True:
            yield await inbox.first()

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

    async def _inbox(self, layer) -> Inbox:
        if layer not in self._subscriptions:
            await self.subscribe(layer)
        return self._inboxes[layer]

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
        lost, self._hull_forces = self._hull_forces, Inbox(_MAX_WAITING_FRAMES)
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


def connect(url: str = "http://127.0.0.1:8080", *, room: str = "", name: str = "", token: str = "", client: str = "", patience_s: float = 10.0,
            answer_within_s: float = 10.0) -> Water:
    """A room of the server at `url`; "host:port", the page's address and ws addresses are understood. To be used with `async with`, which waits
    until the server has let the client in: for `patience_s` while the server cannot be reached (ConnectionLost), not at all if it says no (Refused). `name`:
    shown to others. `token`: gives a role. `client`: name and version of the program, for the server's log."""
    return Water(url, room=room, name=name, token=token, client=client, patience_s=patience_s, answer_within_s=answer_within_s)


def _version():
    try:
        return metadata.version("spindrift-client")
    except metadata.PackageNotFoundError:
        return "from a checkout"


def _fetch(url, token):
    request = urllib.request.Request(url, headers={"Authorization": f"Bearer {token}"} if token else {})
    try:
        with urllib.request.urlopen(request, timeout=30) as answer:
            return answer.read()
    except urllib.error.HTTPError as error:
        raise SpindriftError(f"{url}: HTTP {error.code}: {_problem(error.read())}") from error
    except urllib.error.URLError as error:
        raise ConnectionLost(f"{url}: {error.reason}") from error


def _problem(body):
    try:
        return json.loads(body)["message"]
    except (ValueError, KeyError, TypeError):
        return body.decode(errors="replace").strip()

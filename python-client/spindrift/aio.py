"""A room for asyncio: `async with connect("http://localhost:8080") as water: ...`"""
from __future__ import annotations

import asyncio
import contextlib
from typing import AsyncIterator

import websockets
from google.protobuf import json_format

from . import commands, queries
from .clock import Clock
from .errors import ConnectionLost, NoAnswer, SpindriftError
from .frames import LAYERS, Boats, Floaters, Foam, Frame, Particles, Surface
from .gauges import GaugeSeries
from .hulls import HullForces
from .inbox import Inbox
from .queries import Answer
from .rest import fetch
from .session import MAX_WAITING_FRAMES, WIRE_VERSION, Event, Session
from .v1 import api_pb2 as api
from .v1 import wire_pb2 as wire

__all__ = ["WIRE_VERSION", "Clock", "Event", "Water", "connect"]

_MAX_WAITING_COMMANDS = 64
_MAX_WAITING_ANSWERS = 64
_SLOW_ACTIONS = ("change_scene", "set_parameter")
"""The server builds water for these, as long as that takes."""


@commands.add_methods
class Water(Session):
    """A room of a server. Use `connect`. Connects again by itself, as the same person with the same boats.

    Frames wait in bounded queues, one for each layer: a reader that is too slow loses the oldest, which `dropped` counts. Everything is
    used from one event loop. Methods named like commands of the wire (`splash`, `spawn_boat`, `set_parameter`, ...) take the fields
    of their messages as arguments; help() of each lists them with units and bounds."""

    # ---- what is known of the room

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
        self._inboxes.setdefault(layer, Inbox(MAX_WAITING_FRAMES))
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

    async def _inbox(self, layer) -> Inbox:
        if layer not in self._subscriptions:
            await self.subscribe(layer)
        return self._inboxes[layer]

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
        text = await asyncio.get_running_loop().run_in_executor(None, fetch, self._address.rest(f"rooms/{room}/{path}"), self._address.token)
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


def connect(url: str = "http://127.0.0.1:8080", *, room: str = "", name: str = "", token: str = "", client: str = "", patience_s: float = 10.0,
            answer_within_s: float = 10.0) -> Water:
    """A room of the server at `url`; "host:port", the page's address and ws addresses are understood. To be used with `async with`, which waits
    until the server has let the client in: for `patience_s` while the server cannot be reached (ConnectionLost), not at all if it says no (Refused). `name`:
    shown to others. `token`: gives a role. `client`: name and version of the program, for the server's log."""
    return Water(url, room=room, name=name, token=token, client=client, patience_s=patience_s, answer_within_s=answer_within_s)

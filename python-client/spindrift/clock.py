"""A room's clock in the hands of a client."""
from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING

from .errors import SpindriftError
from .v1 import wire_pb2 as wire

if TYPE_CHECKING:
    from .aio import Water

MAX_TICKS = 600
"""Of one Step."""


class Clock:
    """`async with water.clock() as clock: ack = await clock.step(60)`. Inside, the room advances only by `step`. With several holders, by the
    ticks that all of them have asked for. Entering raises what commands raise (FORBIDDEN: for operators, and for players who are alone)."""

    def __init__(self, water: "Water", speed: float, timeout_s: float):
        self._water, self._speed, self._timeout_s = water, speed, timeout_s

    async def __aenter__(self) -> "Clock":
        await self._water.take_clock(speed=self._speed, timeout_s=self._timeout_s)
        return self

    async def __aexit__(self, *_):
        with contextlib.suppress(SpindriftError):  # a lost connection, or a time-out before: then the room has its clock already
            await self._water.release_clock()

    async def step(self, tick_count: int = 1) -> wire.Ack:
        """Advances the room and returns when the ticks are done: `applied_tick` is the last of them, `state_hash` that of the state after
        it. More than 600 ticks are several commands. Raises what commands raise: Rejected if the clock was lost, or if something else,
        such as a reset, ended the steps."""
        if tick_count < 1:
            raise ValueError(f"tick_count {tick_count}: it has to be 1 or more")
        for begun in range(0, tick_count, MAX_TICKS):
            ack = await self._water.step(tick_count=min(tick_count - begun, MAX_TICKS), waits=True)
        return ack

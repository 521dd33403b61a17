"""Frames and events that wait for their reader: at most so many, the oldest make room and are counted."""
from __future__ import annotations

import asyncio
from collections import deque


class Inbox:
    def __init__(self, capacity: int):
        self._waiting: deque = deque(maxlen=capacity)
        self._changed = asyncio.Event()
        self._failure: Exception | None = None
        self.dropped = 0
        """How many were dropped for newer ones."""

    def put(self, item):
        self.dropped += len(self._waiting) == self._waiting.maxlen
        self._waiting.append(item)
        self._changed.set()

    def fail(self, error: Exception):
        """Nothing comes any more: readers get what waits, then the error."""
        self._failure = error
        self._changed.set()

    async def first(self):
        """The oldest that waits."""
        await self._some()
        return self._waiting.popleft()

    async def newest(self):
        """The newest; the others that wait count as dropped."""
        await self._some()
        self.dropped += len(self._waiting) - 1
        item = self._waiting.pop()
        self._waiting.clear()
        return item

    async def _some(self):
        while not self._waiting:
            if self._failure is not None:
                raise self._failure
            self._changed.clear()
            await self._changed.wait()

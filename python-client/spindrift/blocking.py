"""The same room without asyncio: every call waits. `with connect("http://localhost:8080") as water: ...`"""
from __future__ import annotations

import asyncio
import functools
import inspect
import threading

from . import aio


class _Loop:
    """An event loop in a thread of its own."""

    def __init__(self):
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="spindrift", daemon=True)
        self._thread.start()

    def run(self, coroutine):
        """Waits for a coroutine. Interrupted (Ctrl+C), it is cancelled."""
        future = asyncio.run_coroutine_threadsafe(coroutine, self._loop)
        try:
            return future.result()
        except BaseException:
            future.cancel()
            raise

    def close(self):
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()


class Clock:
    """clock.Clock with calls that wait: `with water.clock() as clock: ack = clock.step(60)`."""

    def __init__(self, loop: _Loop, clock: aio.Clock):
        self._loop, self._clock = loop, clock

    def __enter__(self) -> "Clock":
        self._loop.run(self._clock.__aenter__())
        return self

    def __exit__(self, *error):
        self._loop.run(self._clock.__aexit__(*error))

    def step(self, tick_count: int = 1):
        """As clock.Clock.step."""
        return self._loop.run(self._clock.step(tick_count))


class Water:
    """aio.Water with calls that wait and generators instead of asynchronous ones; its attributes are the same. Usable from several threads."""

    def __init__(self, **arguments):
        self._loop = _Loop()
        try:
            self._water = self._loop.run(self._enter(arguments))
        except BaseException:
            self._loop.close()
            raise

    @staticmethod
    async def _enter(arguments):
        return await aio.connect(**arguments).__aenter__()

    def __enter__(self) -> "Water":
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Leaves the room."""
        if self._loop is not None:
            self._loop.run(self._water.close())
            self._loop.close()
            self._loop = None

    def __getattr__(self, name):
        if name.startswith("_"):  # not yet connected, or asked for by copy and pickle
            raise AttributeError(name)
        value = getattr(self._water, name)
        if not inspect.ismethod(value):
            return value

        @functools.wraps(value)
        def call(*arguments, **named):
            result = value(*arguments, **named)
            if inspect.isasyncgen(result):
                return self._each(result)
            if isinstance(result, aio.Clock):
                return Clock(self._loop, result)
            return self._loop.run(result) if inspect.iscoroutine(result) else result

        return call

    def __dir__(self):
        return sorted({*super().__dir__(), *dir(self._water)})

    def _each(self, generator):
        try:
            while True:
                yield self._loop.run(generator.__anext__())
        finally:
            if self._loop is not None:
                self._loop.run(generator.aclose())


def connect(url: str = "http://127.0.0.1:8080", **options) -> Water:
    """As aio.connect, with the same options, and connected when it returns."""
    return Water(url=url, **options)


connect.__doc__ += "\n\n    " + aio.connect.__doc__

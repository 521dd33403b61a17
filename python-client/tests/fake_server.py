"""A server that says what a test wants: for what the real one never does."""
import asyncio
import contextlib

import websockets

from spindrift.v1 import wire_pb2 as wire


class FakeServer:
    """`received`: the clients' messages; `send`: to the newest client; `sockets`: all of them."""

    def __init__(self):
        self.url = ""
        self.greeting = wire.Greeting(version=wire.Version(major=1, minor=99), room="main")
        self.sockets: list = []
        self.received: asyncio.Queue = asyncio.Queue()
        self.connection_count = 0
        self._socket = None

    async def handle(self, socket):
        self._socket = socket
        self.sockets.append(socket)
        self.connection_count += 1
        await self.send(greeting=self.greeting)
        async for data in socket:
            message = wire.ClientMessage()
            message.ParseFromString(data)
            if message.HasField("hello"):
                await self.say(socket, welcome=wire.Welcome(role=wire.ROLE_PLAYER, person_id=7, resume_key="key"))
            await self.received.put(message)

    async def send(self, raw=None, **message):
        await self.say(self._socket, raw, **message)

    @staticmethod
    async def say(socket, raw=None, **message):
        await socket.send(raw if raw is not None else wire.ServerMessage(**message).SerializeToString())

    async def close(self, code, reason=""):
        await self._socket.close(code, reason)

    async def next(self, kind):
        """The next message of a kind from a client."""
        while True:
            message = await asyncio.wait_for(self.received.get(), 30)
            if message.HasField(kind):
                return getattr(message, kind)


@contextlib.asynccontextmanager
async def fake_server():
    fake = FakeServer()
    async with websockets.serve(fake.handle, "127.0.0.1", 0, subprotocols=["spindrift.v1"]) as running:
        fake.url = f"http://127.0.0.1:{list(running.sockets)[0].getsockname()[1]}"
        yield fake

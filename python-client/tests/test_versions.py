"""Messages of every minor version of the wire, read by this client (tests/golden/versions.txt)."""
import asyncio

import pytest
from conftest import PROJECT
from fake_server import fake_server

from spindrift import aio
from spindrift.v1 import wire_pb2 as wire

LINES = [line.split() for line in (PROJECT / "tests" / "golden" / "versions.txt").read_text().splitlines() if not line.startswith("#")]
VERSIONS = list(dict.fromkeys(line[0] for line in LINES))
SILENT = ("greeting", "welcome", "ack", "reject", "diagnostics", "pong", "query_answer", "hull_forces")
"""Kinds that are no events of their own, or come before the others."""


def said(version):
    """What servers of a version say, by kind: a version has lines for what differs from the one before."""
    until = VERSIONS[: VERSIONS.index(version) + 1]
    return {kind: bytes.fromhex(data) for of, side, kind, data in LINES if side == "server" and of in until}


def test_every_version_is_there():
    assert VERSIONS == [f"1.{minor}" for minor in range(aio.WIRE_VERSION[1] + 1)]


@pytest.mark.parametrize("version", VERSIONS)
def test_a_server_of_this_version_is_understood(version):
    async def run():
        messages = said(version)
        async with fake_server() as fake:
            fake.greeting = wire.ServerMessage.FromString(messages["greeting"]).greeting
            assert fake.greeting.version.minor == int(version.split(".")[1])
            async with aio.connect(fake.url) as water:
                assert (water.greeting.version.minor, water.scene.wave.resolution_count) == (fake.greeting.version.minor, 32)
                await water.subscribe("diagnostics")
                events = water.events()
                # A refusal ends the session, and draining is its last event.
                order = sorted((kind for kind in messages if kind not in ("greeting", "welcome", "refusal")), key=lambda kind: kind == "draining")
                for kind in order:
                    assert wire.ServerMessage.FromString(messages[kind]).WhichOneof("message") == kind
                    await fake.send(raw=messages[kind])
                told = {"draining": "moving"}
                wanted = [told.get(kind, kind) for kind in order if kind not in SILENT]
                seen = []
                while len(seen) < len(wanted):
                    event = await asyncio.wait_for(events.__anext__(), 30)
                    if event.kind not in ("greeting", "live"):
                        seen.append(event.kind)
                assert seen == wanted
                assert (await water.next("diagnostics")).tick == 1
                assert water.damaged_count == 0 and len(water.people) == 1
                if "hull_forces" in messages:
                    assert (await water.hull_forces()).tick == 1

    asyncio.run(run())

"""What a session does when the other end does something unusual: a server of the tests says it."""
import asyncio
import pathlib

import pytest
from fake_server import fake_server

from spindrift import ConnectionLost, NoAnswer, Refused, Rejected, SpindriftError, aio
from spindrift.queries import VALUES
from spindrift.v1 import wire_pb2 as wire

GOLDEN = pathlib.Path(__file__).resolve().parents[2] / "tests" / "golden"


def scenario(body):
    """Runs a coroutine with a fake server."""
    def test():
        async def run():
            async with fake_server() as fake:
                await asyncio.wait_for(body(fake), 60)

        asyncio.run(run())

    test.__name__ = body.__name__
    test.__doc__ = body.__doc__
    return test


async def until(events, kind):
    async for event in events:
        if event.kind == kind:
            return event


def golden(file):
    return (GOLDEN / file).read_bytes()


@scenario
async def test_a_newer_minor_version_works(fake):
    async with aio.connect(fake.url) as water:
        assert (water.role, water.welcome.person_id) == ("player", 7)
        unknown_kind = b"\xfa\x7f\x03abc"  # field 2047 of ServerMessage
        await fake.send(raw=unknown_kind)
        waiting = asyncio.ensure_future(water.splash(x_m=1))
        command = await fake.next("command")
        await fake.send(ack=wire.Ack(command_id=command.command_id, applied_tick=5))
        assert (await waiting).applied_tick == 5


@scenario
async def test_another_major_version_is_refused_in_a_sentence(fake):
    fake.major = 2
    with pytest.raises(Refused, match=r"the server speaks 2.99 of the wire, this client 1\.\d+: update the older one"):
        async with aio.connect(fake.url):
            pass
    assert fake.connection_count == 1


@scenario
async def test_a_refusal_is_final_and_told_to_everybody_who_waits(fake):
    async with aio.connect(fake.url) as water:
        frame, command = asyncio.ensure_future(water.surface()), asyncio.ensure_future(water.splash())
        await fake.next("command")
        await fake.send(refusal=wire.Refusal(message="the room was closed"))
        for waiting in (frame, command, asyncio.ensure_future(water.foam())):
            with pytest.raises(Refused, match="the room was closed"):
                await waiting
    assert fake.connection_count == 1


@scenario
async def test_close_codes_that_are_final_carry_their_code(fake):
    async with aio.connect(fake.url) as water:
        await fake.close(4409, "continued elsewhere")
        with pytest.raises(Refused, match="continued elsewhere") as refused:
            await water.surface()
        assert refused.value.close_code == 4409


@scenario
async def test_a_lost_connection_is_made_again_with_the_resume_key_and_subscriptions(fake):
    async with aio.connect(fake.url) as water:
        await water.subscribe("surface", rate_hz=5, level="coarse")
        await fake.next("subscribe")
        command = asyncio.ensure_future(water.splash())
        await fake.next("command")
        events = water.events()
        await fake.close(1011, "it failed")
        with pytest.raises(ConnectionLost, match="may or may not have been carried out"):
            await command
        assert "it failed" in (await until(events, "lost")).text
        with pytest.raises(ConnectionLost, match="was not sent"):
            await water.splash()
        await until(events, "live")
        hello, again = await fake.next("hello"), await fake.next("subscribe")
        assert hello.resume_key == "key"
        assert (again.max_rate_hz, again.level) == (5, wire.LEVEL_COARSE)


@scenario
async def test_it_moves_to_the_server_that_draining_names(fake):
    async with fake_server() as other, aio.connect(fake.url) as water:
        events = water.events()
        await fake.send(draining=wire.Draining(closes_in_s=5, go_to=other.url.replace("http", "ws"), reconnect_after_min_s=0.1, reconnect_after_max_s=0.2))
        await until(events, "moving")
        await until(events, "live")
        assert (fake.connection_count, other.connection_count) == (1, 1)
        assert (await other.next("hello")).resume_key == "key"


@scenario
async def test_damaged_frames_are_counted_and_a_new_beginning_is_asked_for(fake):
    async with aio.connect(fake.url) as water:
        await water.subscribe("surface")
        await fake.next("subscribe")
        await fake.send(raw=golden("surface_packed_0.bin"))
        first = await water.surface()
        await fake.send(raw=golden("bad_surface_crc.bin"))
        await fake.next("subscribe")
        await fake.send(raw=b"\x0a\xff")
        await fake.send(raw="a text message")
        await fake.send(raw=golden("surface_packed_0.bin"))
        assert (await water.surface()).tick == first.tick
        assert water.damaged_count == 3


@scenario
async def test_slow_readers_lose_the_oldest_frames_which_are_counted(fake):
    async with aio.connect(fake.url) as water:
        await water.subscribe("surface")
        await fake.next("subscribe")
        for _ in range(50):
            await fake.send(raw=golden("surface_packed_0.bin"))
        await fake.send(raw=golden("surface_packed_1.bin"))
        while water.dropped["surface"] < 35:
            await asyncio.sleep(0.01)
        newest = await water.surface()
        assert water.dropped["surface"] == 50
        assert newest.tick > 0


@scenario
async def test_answers_are_errors_by_their_kind_and_waiting_commands_are_bounded(fake):
    async with aio.connect(fake.url, answer_within_s=0.5) as water:
        waiting = asyncio.ensure_future(water.splash(radius_m=1e9))
        command = await fake.next("command")
        await fake.send(reject=wire.Reject(command_id=command.command_id, reason=wire.REJECT_REASON_OUT_OF_RANGE, field="splash.radius_m", message="too large"))
        with pytest.raises(Rejected, match="too large") as rejected:
            await waiting
        assert (rejected.value.reason, rejected.value.field) == ("OUT_OF_RANGE", "splash.radius_m")
        many = [asyncio.ensure_future(water.splash()) for _ in range(65)]
        results = await asyncio.gather(*many, return_exceptions=True)
        assert [type(result) for result in results] == [NoAnswer] * 64 + [SpindriftError]
        assert "64 commands wait" in str(results[64])


@scenario
async def test_a_query_that_the_server_ends_is_an_error_and_so_is_a_lost_connection(fake):
    async with aio.connect(fake.url) as water:
        for end in ("scene", "connection"):
            stream = water.stream_query([[0.0, 1.0]])
            first = asyncio.ensure_future(stream.__anext__())
            command = await fake.next("command")
            await fake.send(ack=wire.Ack(command_id=command.command_id, applied_tick=5))
            result = wire.QueryResult(query_id=command.query.query_id, **{name: [0.5] for name in VALUES})
            await fake.send(query_answer=wire.QueryAnswer(tick=5, results=[result]))
            assert (await first).elevation_m.tolist() == [0.5]
            second = asyncio.ensure_future(stream.__anext__())
            if end == "scene":
                over = wire.QueryResult(query_id=command.query.query_id, last=True, ended="the scene has changed")
                await fake.send(query_answer=wire.QueryAnswer(tick=6, results=[over]))
                with pytest.raises(SpindriftError, match="the scene has changed"):
                    await second
            else:
                await fake.close(1001)
                with pytest.raises(ConnectionLost):
                    await second


def test_no_server_is_an_error_after_the_patience():
    async def run():
        async with aio.connect("http://127.0.0.1:1", patience_s=0.2):
            pass

    with pytest.raises(ConnectionLost, match="no connection to ws://127.0.0.1:1/ws within 0.2 s"):
        asyncio.run(run())

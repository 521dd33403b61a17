"""What a session does when the other end does something unusual: a server of the tests says it."""
import asyncio
import pathlib

import numpy as np
import pytest
from fake_server import fake_server

from spindrift import ConnectionLost, NoAnswer, Refused, Rejected, SpindriftError, aio
from spindrift.queries import VALUES
from spindrift.v1 import wire_pb2 as wire

GOLDEN = pathlib.Path(__file__).resolve().parents[2] / "tests" / "golden"


# For what hangs, not for slow machines.
LONGEST_S = 300


def scenario(body):
    """Runs a coroutine with a fake server."""
    def test():
        async def run():
            async with fake_server() as fake:
                await asyncio.wait_for(body(fake), LONGEST_S)

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
    fake.greeting.version.major = 2
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


@scenario
async def test_a_clock_is_held_for_a_block_and_steps_are_answered_when_they_are_done(fake):
    async with aio.connect(fake.url, answer_within_s=0.2) as water:
        async def answer(action, **ack):
            command = await fake.next("command")
            assert command.WhichOneof("action") == action
            await fake.send(ack=wire.Ack(command_id=command.command_id, **ack))
            return getattr(command, action)

        async def steps():
            async with water.clock(timeout_s=3) as clock:
                return [await clock.step(60), await clock.step(601)]

        running = asyncio.ensure_future(steps())
        taken = await answer("take_clock", applied_tick=5)
        assert (taken.timeout_s, taken.speed) == (3, 0)
        await asyncio.sleep(0.4)  # longer than other commands may take
        step = await answer("step", applied_tick=65, state_hash=2**64 - 1)
        assert (step.tick_count, step.waits) == (60, True)
        assert [(await answer("step", applied_tick=tick, state_hash=9)).tick_count for tick in (665, 666)] == [600, 1]
        await answer("release_clock", applied_tick=666)
        first, second = await running
        assert (first.applied_tick, first.state_hash) == (65, 2**64 - 1)
        assert (second.applied_tick, second.HasField("state_hash")) == (666, True)


@scenario
async def test_a_clock_that_was_lost_is_an_error_of_its_steps(fake):
    async with aio.connect(fake.url) as water:
        async def steps():
            async with water.clock() as clock:
                await clock.step(1)

        running = asyncio.ensure_future(steps())
        taken = await fake.next("command")
        await fake.send(ack=wire.Ack(command_id=taken.command_id, applied_tick=5))
        step = await fake.next("command")
        await fake.send(reject=wire.Reject(command_id=step.command_id, reason=wire.REJECT_REASON_NOT_NOW, message="the clock timed out"))
        released = await fake.next("command")
        assert released.HasField("release_clock")
        await fake.send(reject=wire.Reject(command_id=released.command_id, reason=wire.REJECT_REASON_NOT_NOW, message="not held"))
        with pytest.raises(Rejected, match="the clock timed out"):
            await running
        running = asyncio.ensure_future(steps())
        taken = await fake.next("command")
        await fake.send(ack=wire.Ack(command_id=taken.command_id, applied_tick=6))
        await fake.next("command")
        await fake.close(1011)
        with pytest.raises(ConnectionLost):
            await running


def hulls(tick):
    force = wire.HullForce(boat_id=3, hydrostatic=wire.Wrench(force_y_n=100, moment_pitch_nm=2), dynamic=wire.Wrench(force_x_n=-4), drag=wire.Wrench(force_x_n=-1))
    return wire.HullForces(tick=tick, time_s=tick / 60, state_id=tick, hulls=[wire.HullForce(boat_id=1), force])


@scenario
async def test_moved_boats_get_their_forces_newest_first_or_in_order(fake):
    async with aio.connect(fake.url) as water:
        moving = asyncio.ensure_future(water.move_boat(boat_id=3, x_m=1.5, heading_rad=0.25, velocity_x_mps=2))
        command = await fake.next("command")
        assert (command.move_boat.boat_id, command.move_boat.x_m, command.move_boat.velocity_x_mps) == (3, 1.5, 2)
        await fake.send(ack=wire.Ack(command_id=command.command_id, applied_tick=7))
        await moving
        stream = water.stream_hull_forces()
        for tick in (7, 8, 9):
            await fake.send(hull_forces=hulls(tick))
        assert [(await stream.__anext__()).tick for _ in range(2)] == [7, 8]
        forces = await water.hull_forces()
        row = forces.index_of(3)
        assert (forces.tick, forces.state_id, row, forces.index_of(99)) == (9, 9, 1, None)
        assert forces.total.force_n[row].tolist() == [-5, 100, 0] and forces.hydrostatic.moment_nm[row].tolist() == [0, 2, 0]
        assert forces.drag.force_n.shape == (2, 3) and forces.dynamic.force_n.dtype == np.float64
        for tick in range(100, 150):
            await fake.send(hull_forces=hulls(tick))
        while water.dropped.get("hull_forces", 0) < 34:
            await asyncio.sleep(0.01)
        assert (await water.hull_forces()).tick == 149
        assert water.dropped["hull_forces"] == 49
        waiting = [asyncio.ensure_future(water.hull_forces()), asyncio.ensure_future(stream.__anext__())]
        await asyncio.sleep(0)
        await fake.close(1001)
        for each in waiting:
            with pytest.raises(ConnectionLost):
                await each


@scenario
async def test_a_hundred_clients_keep_their_bounds_and_lose_no_command_without_an_error(fake):
    clients = [await aio.connect(fake.url, answer_within_s=LONGEST_S).__aenter__() for _ in range(100)]
    try:
        for client in clients:
            await client.subscribe("surface")
        for _ in range(100):
            await fake.next("subscribe")
        commands = [asyncio.ensure_future(client.splash()) for client in clients for _ in range(70)]
        for _ in range(100 * 64):
            await fake.next("command")
        frame, sent = golden("surface_packed_0.bin"), 60
        for socket in fake.sockets:
            for _ in range(sent):
                await fake.say(socket, frame)
        while min(client.dropped["surface"] for client in clients) < sent - 16:
            await asyncio.sleep(0.01)
        assert [client.dropped["surface"] for client in clients] == [sent - 16] * 100
        for k, socket in enumerate(fake.sockets):
            for command_id in range(1, 33):
                await fake.say(socket, ack=wire.Ack(command_id=command_id, applied_tick=k))
            await socket.close(1011)
        ends = [type(end) for end in await asyncio.gather(*commands, return_exceptions=True)]
        assert {kind: ends.count(kind) for kind in set(ends)} == {wire.Ack: 3200, ConnectionLost: 3200, SpindriftError: 600}
    finally:
        await asyncio.gather(*(client.close() for client in clients))


def test_no_server_is_an_error_after_the_patience():
    async def run():
        async with aio.connect("http://127.0.0.1:1", patience_s=0.2):
            pass

    with pytest.raises(ConnectionLost, match="no connection to ws://127.0.0.1:1/ws within 0.2 s"):
        asyncio.run(run())

"""Commands from arguments, addresses, and boxes in which frames wait."""
import asyncio

import pytest

from conftest import PROJECT

from spindrift import aio
from spindrift.address import parse
from spindrift.commands import ACTIONS, build
from spindrift.inbox import Inbox


def test_commands_take_fields_enums_and_inner_messages():
    assert build("splash", {"x_m": 1, "depth_m": 0.5}).splash.depth_m == 0.5
    assert build("breaking_wave", {"side": "plus_x"}).breaking_wave.side == build("breaking_wave", {"side": "SIDE_PLUS_X"}).breaking_wave.side != 0
    assert build("spawn_boat", {"x_m": 2, "length_m": 3}).spawn_boat.boat.length_m == 3
    assert build("stroke", {"stroke_id": 1, "points": [{"time_s": 0, "x_m": 1}, {"time_s": 0.1, "x_m": 2}]}).stroke.points[1].x_m == 2
    assert build("set_lesson", {"frozen": True, "tools": ["rain", "boat"]}).set_lesson.lesson.tools == [2, 7]
    assert build("reset", {}).WhichOneof("action") == "reset"


@pytest.mark.parametrize("action, fields, text", [
    ("splash", {"depth": 1}, "splash has no 'depth'; it has x_m, z_m, radius_m, depth_m"),
    ("breaking_wave", {"side": "up"}, "side cannot be 'up'; it can be SIDE_"),
    ("jump", {}, "there is no command 'jump'; there are splash"),
    ("splash", {"depth_m": "deep"}, "")])
def test_faulty_commands_say_what_would_be_right(action, fields, text):
    with pytest.raises(TypeError, match=text):
        build(action, fields)


def test_every_command_is_a_method_that_says_its_bounds():
    for action in ACTIONS:
        if action != "query":  # which returns the answer, not its Ack
            assert getattr(aio.Water, action).__doc__.startswith(f"Sends {action}")
    assert "depth_m: Splash depth, 0.0001 to 50 m; 0.8 if left out" in aio.Water.splash.__doc__


@pytest.mark.parametrize("url, room, socket", [
    ("localhost:8080", "", "ws://localhost:8080/ws"),
    ("http://host:1/?room=b#token=t", "", "ws://host:1/ws/b"),
    ("https://host/water/", "a b", "wss://host/water/ws/a%20b"),
    ("ws://host:2/ws/c", "", "ws://host:2/ws/c"),
    ("wss://[::1]:5/ws/c", "d", "wss://[::1]:5/ws/d")])
def test_addresses(url, room, socket):
    assert parse(url, room).socket == socket


def test_an_address_has_a_token_and_can_move():
    address = parse("http://host:1/sea/?room=b#token=t")
    assert address.token == "t" and parse("http://host#token=t", token="u").token == "u"
    assert address.moved("wss://other:9").socket == "wss://other:9/sea/ws/b"
    assert address.rest("rooms") == "http://host:1/sea/api/v1/rooms"


@pytest.mark.parametrize("url", ["ftp://host", "http://", ""])
def test_what_is_not_an_address(url):
    with pytest.raises(ValueError, match="not the address of a server"):
        parse(url)


def test_an_inbox_is_bounded_and_counts():
    async def run():
        inbox = Inbox(3)
        for k in range(5):
            inbox.put(k)
        assert (await inbox.first(), inbox.dropped) == (2, 2)
        assert (await inbox.newest(), inbox.dropped) == (4, 3)
        inbox.put(5)
        inbox.fail(RuntimeError("over"))
        assert await inbox.first() == 5
        with pytest.raises(RuntimeError, match="over"):
            await inbox.newest()

    asyncio.run(run())


def test_the_version_is_that_of_the_wire():
    text = (PROJECT / "proto" / "README.md").read_text()
    assert f"with its version (this is {aio.WIRE_VERSION[0]}.{aio.WIRE_VERSION[1]})" in text

"""Both interfaces against the real server."""
import asyncio
import os
import signal
import threading
import time

import numpy as np
import pytest
from conftest import ENVIRONMENT, PROJECT

import spindrift
from spindrift import aio


def test_every_layer_arrives_in_metres(water):
    surface = water.surface()
    assert surface.heights_m.shape == (64, 64) and surface.heights_m.dtype == np.float32
    assert (surface.x_m[0], surface.x_m[-1]) == pytest.approx((-4 + 1 / 16, 4 - 1 / 16))
    particles = water.particles()
    assert particles.positions_m.shape == particles.velocities_mps.shape == (len(particles.foam), 3)
    assert np.all(np.abs(particles.positions_m) < 5)
    boat_id = water.spawn_boat(x_m=1, z_m=-2, heading_deg=90).boat_id
    floater_id = water.spawn_floater(kind="crate", x_m=-1, z_m=2).floater_id
    assert water.foam().white.shape[0] > 8
    for boats in water.frames("bodies"):
        if boats.index_of(boat_id) is not None:
            break
    k = boats.index_of(boat_id)
    assert boats.positions_m[k][[0, 2]] == pytest.approx([1, -2], abs=0.2)
    assert boats.heading_rad[k] == pytest.approx(np.pi / 2, abs=0.1)
    for floaters in water.frames("floaters"):
        if floater_id in floaters.ids:
            break
    assert np.linalg.norm(floaters.rotations, axis=1) == pytest.approx(1)
    assert water.next("diagnostics").boat_count == 1
    water.remove_boat(boat_id=boat_id)


def test_packed_and_plain_surfaces_are_equal_to_the_bit(server, water):
    water.splash(x_m=1, z_m=1, depth_m=0.3)
    water.set_paused(paused=True)
    with server.connect() as other:
        other.subscribe("surface", packed=False)
        packed = water.advance(20)
        plain = other.surface_at(packed.tick)
        assert (plain.tick, plain.state_id) == (packed.tick, packed.state_id)
        np.testing.assert_array_equal(plain.samples, packed.samples)
        assert np.ptp(packed.heights_m) > 0.05


def test_a_splash_is_acknowledged_and_seen_where_it_was(water):
    water.set_paused(paused=True)
    ack = water.splash(x_m=-2, z_m=1, radius_m=0.5, depth_m=0.3)
    after = water.advance(6)
    assert after.tick >= ack.applied_tick
    k, i = np.unravel_index(np.argmin(after.heights_m), after.heights_m.shape)
    assert (after.x_m[i], after.z_m[k]) == pytest.approx((-2, 1), abs=0.4)


def test_what_cannot_be_is_rejected_with_field_and_bound(water):
    with pytest.raises(spindrift.Rejected, match="100 m") as rejected:
        water.splash(x_m=0, radius_m=1000)
    assert (rejected.value.reason, rejected.value.field) == ("OUT_OF_RANGE", "splash.radius_m")
    with pytest.raises(spindrift.Rejected) as rejected:
        water.splash(x_m=float("nan"))
    assert rejected.value.reason == "NOT_FINITE"
    with pytest.raises(spindrift.Rejected):
        water.set_parameter(path="wave.nothing", value=1)


def test_parameters_follow_what_is_set(water):
    damping = water.parameters["wave.damping_per_s"]
    assert (damping.unit, damping.value) == ("1/s", pytest.approx(0.2))
    water.set_parameter(path="wave.damping_per_s", value=0.3)
    for event in water.events():
        if event.kind == "parameter_changed":
            break
    assert water.parameters["wave.damping_per_s"].value == pytest.approx(0.3)


def test_a_gauge_agrees_with_the_surface(water):
    water.set_paused(paused=True)
    water.splash(x_m=0.5, z_m=0, depth_m=0.3)
    frame = water.advance(30)
    water.advance(3)  # readings come some ticks later
    gauge = water.gauge("middle")
    at = np.argmin(np.abs(gauge.time_s - frame.time_s))
    assert gauge.time_s[at] == pytest.approx(frame.time_s)
    assert abs(gauge.elevation_m[at]) > 0.01
    assert gauge.elevation_m[at] == pytest.approx(float(frame.height_m(gauge.x_m, gauge.z_m)), abs=2 * frame.quantum_m)
    with pytest.raises(spindrift.SpindriftError, match="HTTP 404"):
        water.gauge("nowhere")


def test_a_query_agrees_with_the_surface_of_its_tick(water):
    water.splash(x_m=1, z_m=1, depth_m=0.3)
    water.set_paused(paused=True)
    surface = water.advance(20)
    points = np.array([[1.0, 1.0], [-2.3, 0.4], [3.99, -3.99], [0.1, 50.0]])
    answer = water.query(points)
    assert (answer.tick, answer.state_id, answer.time_s) == (surface.tick, surface.state_id, surface.time_s)
    assert answer.outside.tolist() == [False, False, False, True]
    assert answer.elevation_m[:3] == pytest.approx(surface.height_m(points[:3, 0], points[:3, 1]), abs=surface.quantum_m)
    assert answer.elevation_m.dtype == np.float32 and np.ptp(answer.elevation_m) > 0.01
    assert answer.depth_m[0] == pytest.approx(water.scene.wave.depth_m + answer.elevation_m[0], abs=1e-4)
    assert water.advance(1).tick == answer.tick + 1
    assert water.query(points).tick == answer.tick + 1


def test_a_stream_of_answers_has_every_tick_and_ends_with_the_iteration(water):
    water.set_paused(paused=True)
    ticks, outside = [], []
    for answer in water.stream_query([[3.0, 0.0]], velocities=[12.0, 0.0]):
        ticks.append(answer.tick)
        outside.append(bool(answer.outside[0]))
        if len(ticks) == 12:
            break
        water.step(tick_count=1)
    assert ticks == list(range(ticks[0], ticks[0] + 12))
    assert outside == [3 + 12 * k / 60 > 4 for k in range(12)]


def test_a_stream_goes_on_at_another_fidelity_and_ends_with_another_scene():
    with spindrift.serve("wave_only", environment=ENVIRONMENT, patience_s=60, answer_within_s=60) as water:
        stream = water.stream_query([[1.0, 0.5]])
        first = next(stream)
        assert water.scene.fidelity != spindrift.v1.scene_pb2.FIDELITY_DRAFT
        water.change_scene(name="wave_only", fidelity="draft")
        tick = water.query([[1.0, 0.5]]).tick
        assert tick > first.tick
        while next(stream).tick < tick:
            pass
        time.sleep(1.1)  # a room changes its scene once per second
        water.change_scene(name="rain_rings")
        with pytest.raises(spindrift.SpindriftError, match="the scene has changed"):
            while True:
                next(stream)
        assert water.query([[0.1, 0.1]]).wet_ratio.tolist() == [1.0]


def test_faulty_queries_say_what_would_be_right(water):
    with pytest.raises(ValueError, match=r"\[count, 2\]"):
        water.query([1.0, 2.0])
    with pytest.raises(ValueError, match="velocities"):
        water.query([[1.0, 2.0]], velocities=[[1, 1], [2, 2]])
    with pytest.raises(spindrift.Rejected, match="nan is not a finite number") as nan:
        water.query([[0.0, 0.0], [0.0, np.nan]])
    assert nan.value.field == "query.z_m[1]"
    with pytest.raises(spindrift.Rejected, match="1025 points are more than 1024"):
        water.query(np.zeros((1025, 2)))


def test_a_held_clock_makes_exactly_the_ticks_that_are_asked_for_and_repeats(server, water):
    hashes = []
    with water.clock() as clock:
        for _ in range(2):
            water.reset(seed=5)
            water.splash(x_m=1, z_m=1, depth_m=0.3)
            ack = clock.step(40)
            hashes.append(ack.state_hash)
        answer = water.query([[1.0, 1.0]])
        assert answer.tick == ack.applied_tick and abs(answer.elevation_m[0]) > 1e-4
        assert clock.step().applied_tick == answer.tick + 1
        time.sleep(0.3)
        assert water.query([[1.0, 1.0]]).tick == answer.tick + 1
        assert list(water.room_state.clock_person_ids) == [water.welcome.person_id]
        with server.connect() as other, pytest.raises(spindrift.Rejected) as rejected:
            other.set_paused(paused=True)
        assert rejected.value.reason == "CLOCK_HELD"
    assert hashes[0] == hashes[1] != 0
    while water.query([[1.0, 1.0]]).tick < answer.tick + 10:
        pass


def test_a_clock_that_timed_out_is_an_error_of_the_next_step(water):
    with water.clock(timeout_s=0.2) as clock:
        clock.step(2)
        for event in water.events():
            if event.kind == "room_event" and not list(water.room_state.clock_person_ids):
                break
        with pytest.raises(spindrift.Rejected):
            clock.step(2)


def test_a_moved_boat_is_where_it_was_put_and_floats_by_archimedes_law(water):
    water.set_paused(paused=True)
    boat_id = water.spawn_boat(x_m=0, z_m=0, heading_deg=0).boat_id
    boat = next(each for each in water.boats if each.boat_id == boat_id) if water.boats else None
    while boat is None:
        event = next(water.events())
        boat = next((each for each in event.message.boats if each.boat_id == boat_id), None) if event.kind == "boat_list" else None
    lifts_n = []
    for deeper_m in (0.0, 0.05):
        ack = water.move_boat(boat_id=boat_id, x_m=1.5, y_m=0.5 * boat.height_m - boat.draught_m - deeper_m, z_m=-1, heading_rad=0.5)
        water.step(tick_count=1)
        forces = water.hull_forces()
        row = forces.index_of(boat_id)
        assert forces.tick == ack.applied_tick + 1 and len(forces.boat_ids) == 1
        lifts_n.append(forces.hydrostatic.force_n[row][1])
    assert lifts_n[1] > lifts_n[0] > 0
    for boats in water.frames("bodies"):
        k = boats.index_of(boat_id)
        if k is not None and boats.tick >= forces.tick:
            break
    assert boats.positions_m[k][[0, 2]] == pytest.approx([1.5, -1], abs=0.01)
    assert boats.heading_rad[k] == pytest.approx(0.5, abs=0.01)
    water.move_boat(boat_id=boat_id, ends=True)
    water.remove_boat(boat_id=boat_id)
    with pytest.raises(spindrift.Rejected) as rejected:
        water.move_boat(boat_id=boat_id, x_m=float("nan"))
    assert rejected.value.field == "move_boat.x_m"


def test_a_room_that_does_not_exist_is_refused(server):
    with pytest.raises(spindrift.Refused, match="there is no such room"):
        server.connect(room="nowhere")


def test_a_hundred_clients_in_one_process(server, water):
    async def one(k):
        async with aio.connect(server.url, name=f"client {k}", patience_s=120, answer_within_s=120) as client:
            await client.subscribe("surface", rate_hz=10, level="coarse")
            answered = 0
            for _ in range(3):
                try:
                    answered += (await client.splash(x_m=0, depth_m=0.01, radius_m=0.2)).applied_tick > 0
                except spindrift.Rejected as rejected:
                    assert rejected.reason == "BUSY"
                    answered += 1
            frame = await client.surface()
            return answered, frame.tick, client.damaged_count

    async def run():
        return await asyncio.gather(*(one(k) for k in range(100)))

    results = asyncio.run(run())
    assert [answered for answered, _, _ in results] == [3] * 100
    assert all(tick > 0 and damaged == 0 for _, tick, damaged in results)


def test_several_threads_may_use_one_room(water):
    acks, errors = [], []

    def work():
        try:
            acks.extend(water.splash(x_m=0, depth_m=0.01).command_id for _ in range(3))
        except Exception as error:  # pylint: disable=broad-except
            errors.append(error)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not errors and len(set(acks)) == 12


def test_it_goes_on_when_the_server_ends_and_comes_back():
    scene = str(PROJECT / "python-client" / "tests" / "tank.textproto")
    with spindrift.Server(scene, environment=ENVIRONMENT) as first:
        port = first.url.rstrip("/").rsplit(":", 1)[1]
        with first.connect(answer_within_s=60) as water:
            before = water.surface()
            first.stop()
            kinds = []
            again = None
            try:
                for event in water.events():
                    kinds.append(event.kind)
                    if event.kind in ("lost", "moving") and again is None:
                        again = spindrift.Server(scene, environment=ENVIRONMENT, port=int(port))
                    if event.kind == "live" and "lost" in kinds:
                        break
                after = water.surface()
                assert after.heights_m.shape == before.heights_m.shape
                assert water.splash(x_m=0).applied_tick >= 0
            finally:
                if again:
                    again.stop()


def test_it_follows_a_draining_server_to_another_one():
    scene = str(PROJECT / "python-client" / "tests" / "tank.textproto")
    with spindrift.Server(scene, environment=ENVIRONMENT) as other:
        options = ["--drain-s", "4", "--drain-to", other.url.rstrip("/").replace("http", "ws")]
        with spindrift.Server(scene, environment=ENVIRONMENT, options=options) as first, first.connect(name="Ada", answer_within_s=60) as water:
            before = water.surface()
            first.stop()
            kinds = []
            for event in water.events():
                kinds.append(event.kind)
                if event.kind == "live" and "moving" in kinds:
                    break
            assert water.surface().heights_m.shape == before.heights_m.shape
            assert water.splash(x_m=0).applied_tick >= 0
            with other.connect(name="Ben") as ben:
                while sorted(person.name for person in ben.people) != ["Ada", "Ben"]:
                    next(ben.events())


def test_a_server_that_does_not_start_says_why():
    with pytest.raises(spindrift.ServerFailed, match="no_such_scene"):
        spindrift.Server("no_such_scene")
    with pytest.raises(spindrift.ServerFailed, match="No such file"):
        spindrift.Server(program="/nonexistent/spindrift")


def test_a_server_that_dies_is_a_lost_connection():
    with spindrift.Server(str(PROJECT / "python-client" / "tests" / "tank.textproto"), environment=ENVIRONMENT) as server, server.connect() as water:
        water.surface()
        os.kill(server.pid, signal.SIGKILL)
        for event in water.events():
            if event.kind == "lost":
                break
        with pytest.raises(spindrift.ConnectionLost, match="was not sent"):
            water.splash(x_m=0)


"""The boat for ArduPilot; the test is ArduPilot: it sends servo pulses and reads JSON."""
import json
import math
import re
import socket
import struct
import subprocess
import sys
import threading

import numpy as np
import pytest
from conftest import PROJECT

sys.path.insert(0, str(PROJECT / "python-client" / "examples"))
import ardupilot_boat  # noqa: E402  pylint: disable=wrong-import-position


def datagram(frame_count, rudder, throttle, magic=18458, channels=16):
    pulses = [1500] * channels
    pulses[0], pulses[2] = int(1500 + 500 * rudder), int(1500 + 500 * throttle)
    return struct.pack(f"<HHI{channels}H", magic, 50, frame_count, *pulses)


def test_datagrams():
    assert ardupilot_boat.pulses_of(datagram(7, 1, -1))[0] == 7
    assert len(ardupilot_boat.pulses_of(datagram(7, 1, -1, 29569, 32))[1]) == 32
    for faulty in (b"", b"12345678", datagram(1, 0, 0)[:-1], datagram(1, 0, 0, magic=1)):
        assert ardupilot_boat.pulses_of(faulty) is None
    assert [ardupilot_boat.ratio_of(pulse) for pulse in (0, 1000, 1750, 2600)] == [0, -1, 0.5, 1]


def test_the_axes_of_the_body():
    np.testing.assert_allclose(ardupilot_boat.body_axes(0, 0, math.pi / 2), [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], atol=1e-12)
    np.testing.assert_allclose(ardupilot_boat.body_axes(0, math.pi / 2, 0)[0], [0, 0, -1], atol=1e-12)
    np.testing.assert_allclose(ardupilot_boat.body_axes(math.pi / 2, 0, 0)[1], [0, 0, 1], atol=1e-12)


def test_a_boat_is_driven_and_its_motion_comes_back(server, water):
    program = subprocess.Popen([sys.executable, ardupilot_boat.__file__, server.url, "--port", "0"], stdout=subprocess.PIPE, text=True)
    watchdog = threading.Timer(240, program.kill)
    watchdog.start()
    states = []
    try:
        port = int(re.search(r"port (\d+)", program.stdout.readline())[1])
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ardupilot:
            ardupilot.settimeout(120)
            ardupilot.sendto(b"noise", ("127.0.0.1", port))
            # By simulated time: on a slow machine frames are closer together.
            while not states or states[-1]["timestamp"] < states[0]["timestamp"] + 2.6:
                turns = bool(states) and states[-1]["timestamp"] > states[0]["timestamp"] + 1.3
                ardupilot.sendto(datagram(len(states), float(turns), 0.6), ("127.0.0.1", port))
                answer = ardupilot.recv(4096).decode()
                assert answer.startswith("\n") and answer.endswith("\n")
                states.append(json.loads(answer))
    finally:
        watchdog.cancel()
        program.kill()
        program.wait()
        program.stdout.close()
    times = [state["timestamp"] for state in states]
    assert all(later > earlier for earlier, later in zip(times, times[1:]))
    assert all(math.isfinite(number) for state in states for key in ("position", "attitude", "velocity") for number in state[key])
    start, turning = states[0], states[-1]
    straight = next(state for state in states if state["timestamp"] > start["timestamp"] + 1.3)
    assert straight["velocity"][0] > 0.3 and abs(straight["attitude"][2]) < 0.3, "north, ahead"
    assert turning["attitude"][2] > straight["attitude"][2] + 0.1, "the rudder turns it toward east"
    assert np.mean([state["imu"]["gyro"][2] for state in states if state["timestamp"] > start["timestamp"] + 1.9]) > 0.05
    assert np.mean([state["imu"]["accel_body"][2] for state in states if state["timestamp"] > start["timestamp"] + 0.4]) == pytest.approx(-9.81, abs=1.0)
    assert straight["position"][0] > start["position"][0] + 0.3

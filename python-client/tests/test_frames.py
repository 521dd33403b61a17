"""Frames: the golden bytes of the wire, of all versions, as any client has to read them (tests/golden/README.md)."""
import json

import numpy as np
import pytest
from conftest import PROJECT

from spindrift import Damaged, Surface
from spindrift.codec import crc32c
from spindrift.frames import FrameReader
from spindrift.v1 import scene_pb2 as scene
from spindrift.v1 import wire_pb2 as wire

GOLDEN = PROJECT / "tests" / "golden"
CASES = json.loads((GOLDEN / "golden.json").read_text())
FRAMES = [case for case in CASES if case["verdict"] == "bad_frame" or case.get("kind") == "frame"]


def message(file):
    parsed = wire.ServerMessage()
    parsed.ParseFromString((GOLDEN / file).read_bytes())
    return parsed


def read(case):
    """The frame of a case, read after those that it builds on."""
    reader, chain = FrameReader(), [case]
    while follows := chain[0].get("follows"):
        chain.insert(0, next(each for each in CASES if each["file"] == follows))
    for each in chain:
        frame = reader.read(message(each["file"]).frame)
    return frame


def compare(found, expected, tolerance, what):
    found = np.asarray(found, float)
    np.testing.assert_allclose(found, np.asarray(expected, float).reshape(found.shape), rtol=0, atol=tolerance, err_msg=what)


@pytest.mark.parametrize("case", FRAMES, ids=[case["file"] for case in FRAMES])
def test_golden(case):
    if case["verdict"] == "bad_frame":
        with pytest.raises(Damaged):
            read(case)
        return
    frame = read(case)
    assert frame.tick == int(case["tick"])
    compared = 0
    if "elevation_m" in case:
        np.testing.assert_array_equal(frame.heights_m.ravel(), np.array(case["elevation_m"], np.float32))
        compared += 1
    if "position_m" in case:
        compare(frame.positions_m, case["position_m"], 1e-4, "positions")
        compare(frame.velocities_mps, case["velocity_mps"], 1e-4, "velocities")
        compare((frame.density_ratio - 0.5) / 0.6 * 255, case["tint"], 1e-3, "tint")
        compare(frame.foam * 255, case["foam"], 1e-3, "foam")
        compared += 1
    elif "foam" in case:
        np.testing.assert_array_equal(frame.samples.ravel(), case["foam"])
        compared += 1
    if "bodies" in case:
        for k, boat in enumerate(case["bodies"]):
            assert frame.ids[k] == boat["boat_id"]
            compare(frame.positions_m[k], boat["position_m"], 1e-6, "position")
            for name in ("heading_rad", "pitch_rad", "roll_rad", "speed_mps", "throttle_ratio", "rudder_ratio"):
                compare(getattr(frame, name)[k], boat[name], 1e-6, name)
        compared += 1
    if "floaters" in case:
        for k, floater in enumerate(case["floaters"]):
            assert frame.ids[k] == floater["floater_id"]
            compare(frame.positions_m[k], floater["position_m"], 1e-6, "position")
            compare(frame.rotations[k], floater["rotation"], 1e-3, "rotation")
            assert frame.sizes_m[k] == pytest.approx(floater["size_m"])
            assert (frame.kinds[k], frame.held[k]) == (scene.FloaterKind.Value(floater["kind"]), floater["is_held"])
        compared += 1
    assert compared == 1, f"nothing of {case['file']} was compared"


def test_checksum():
    assert crc32c(b"123456789") == 0xE3069283


def test_a_delta_needs_its_base():
    delta = next(case for case in FRAMES if case.get("follows"))
    with pytest.raises(Damaged, match="a delta on tick"):
        FrameReader().read(message(delta["file"]).frame)


def test_an_unknown_codec_is_named():
    with pytest.raises(Damaged, match="does not know"):
        FrameReader().read(wire.LayerFrame(layer=wire.LAYER_SURFACE, keyframe=True))


def test_heights_between_samples():
    samples = np.array([[0, 10], [20, 30], [40, 50]], np.int16)
    surface = Surface(tick=1, state_id=1, time_s=0.0, server_time_s=0.0, level="full", length_m=4.0, width_m=6.0, samples=samples, quantum_m=0.1)
    np.testing.assert_allclose(surface.x_m, [-1, 1])
    np.testing.assert_allclose(surface.z_m, [-2, 0, 2])
    np.testing.assert_allclose(surface.height_m([-1, 1, 0, 0, 99], [-2, 2, 0, 1, -99]), [0, 5, 2.5, 3.5, 1], rtol=1e-6)
    assert surface.height_m(0.0, -1.0) == pytest.approx(1.5)

"""What the tests share: the folders of the project, and a server."""
import pathlib

import pytest

import spindrift

PROJECT = pathlib.Path(__file__).resolve().parents[2]
# The rasteriser computes on the thread that asks: the tests run beside others.
ENVIRONMENT = {"LP_NUM_THREADS": "0"}


@pytest.fixture(scope="module")
def server():
    with spindrift.Server(str(PROJECT / "python-client" / "tests" / "tank.textproto"), environment=ENVIRONMENT, options=["--grace", "300"]) as running:
        yield running


@pytest.fixture
def water(server):
    with server.connect(name="tester", patience_s=60, answer_within_s=60) as connected:
        connected.set_paused(paused=False)
        connected.reset()
        yield connected

"""The examples, and those in docs/python.md and the README, run as they stand."""
import os
import pathlib
import re
import socket
import subprocess
import sys
import threading

import numpy as np
import pytest
from conftest import ENVIRONMENT, PROJECT

EXAMPLES = PROJECT / "python-client" / "examples"
BLOCKS = [block for file in ("docs/python.md", "README.md") for block in re.findall(r"^```python\n(.*?)^```$", (PROJECT / file).read_text(), re.MULTILINE | re.DOTALL)]


def run(file, *arguments):
    done = subprocess.run([sys.executable, EXAMPLES / file, *map(str, arguments)], env={**os.environ, **ENVIRONMENT}, capture_output=True, text=True, timeout=500,
                          check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def number(text, pattern):
    return float(re.search(pattern, text)[1])


def test_surface_statistics(server, water):
    water.splash(x_m=0, depth_m=0.3)
    text = run("surface_statistics.py", server.url, "--seconds", 1)
    assert "samples" in text and number(text, r"significant height ([\d.]+) m") > 0.001


def test_remote_splash(server, water):
    program = subprocess.Popen([sys.executable, EXAMPLES / "remote_splash.py", server.url, "--port", "0", "--count", "1"], stdout=subprocess.PIPE, text=True)
    watchdog = threading.Timer(120, program.kill)
    watchdog.start()
    try:
        port = int(number(program.stdout.readline(), r"port (\d+)"))
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            sender.sendto(b"not a place", ("127.0.0.1", port))
            sender.sendto(b"1.5 -2", ("127.0.0.1", port))
        rest = program.stdout.read()
        assert program.wait() == 0
    finally:
        watchdog.cancel()
        program.kill()
        program.stdout.close()
    assert "not a place" in rest and re.search(r"splash at 1.5, -2 m in tick \d+", rest)


def test_autopilot():
    text = run("autopilot.py", "--seconds", 6, "--after", 2)
    assert number(text, r"autopilot +([\d.]+) degrees") < 10
    assert number(text, r"rudder amidships +([\d.]+) degrees") > 15


def test_data_set(tmp_path):
    files = [tmp_path / name for name in ("a.npz", "b.npz")]
    for file in files:
        run("data_set.py", "--runs", 3, "--ticks", 30, "--output", file)
    one, other = (np.load(file) for file in files)
    assert one["before"].shape == one["after"].shape == (3, 256, 256) and one["splashes"].shape == (3, 3, 3)
    for name in one.files:
        np.testing.assert_array_equal(one[name], other[name])
    assert np.ptp(one["after"][0]) > 0.02 and not np.array_equal(one["after"][0], one["after"][1])


def test_gauge_theory():
    text = run("gauge_theory.py", "--seconds", 20)
    assert number(text, r"to the other ([\d.]+) m") == pytest.approx(number(text, r"wave length ([\d.]+) m"), rel=0.02)
    speeds = [float(each) for each in re.findall(r"speed of the waves from them ([\d.]+) m/s", text)]
    assert speeds == pytest.approx([number(text, r"theory.*speed ([\d.]+) m/s")] * 2, rel=0.05)


@pytest.mark.parametrize("block", BLOCKS, ids=[f"block {k + 1}" for k in range(len(BLOCKS))])
def test_documentation(block, server, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, value in ENVIRONMENT.items():
        monkeypatch.setenv(name, value)
    names = {}
    exec(compile(re.sub(r"http://(localhost|127.0.0.1):8080", server.url.rstrip("/"), block), "example", "exec"), names)  # pylint: disable=exec-used


def test_the_documentation_has_examples():
    assert len(BLOCKS) >= 5 and pathlib.Path(EXAMPLES / "storm.textproto").exists()

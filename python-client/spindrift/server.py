"""A server of one's own: for tests, and for runs that nobody else shall disturb."""
from __future__ import annotations

import contextlib
import os
import re
import shutil
import signal
import subprocess
import tempfile
import threading
from typing import Iterator, Sequence

from . import blocking
from .errors import ServerFailed

_READY = re.compile(r"^Spindrift is ready: (\S+)")
_READY_WITHIN_S = 120.0
_END_WITHIN_S = 30.0


class Server:
    """`spindrift serve` as a child process on this machine. Use it with `with`."""

    def __init__(self, scene: str = "", *, port: int = 0, options: Sequence[str] = (), program: str = "", environment: dict | None = None):
        """`scene`: a name, or a file; empty: the server's default. `port`: 0: any free one. `options`: more of `spindrift serve`. `program`: by
        default $SPINDRIFT_BINARY, or `spindrift` on the PATH. Raises ServerFailed if it does not start."""
        program = program or os.environ.get("SPINDRIFT_BINARY", "") or shutil.which("spindrift") or ""
        if not program:
            raise ServerFailed("there is no program `spindrift` on the PATH: set SPINDRIFT_BINARY, or pass program=")
        command = [program, "serve", "--port", str(port), *(["--scene", scene] if scene else []), *options]
        self._log = tempfile.TemporaryFile("w+", errors="replace")
        self._ready = threading.Event()
        self.url = ""
        try:
            self._process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=self._log, text=True, errors="replace",
                                             env={**os.environ, **(environment or {})})
        except OSError as error:
            raise ServerFailed(f"{program}: {error.strerror}") from error
        self._reading = threading.Thread(target=self._read, daemon=True)
        self._reading.start()
        if not self._ready.wait(_READY_WITHIN_S) or not self.url:
            last = self._last_lines()
            self.stop()
            raise ServerFailed(f"`{' '.join(command)}` did not get ready:\n{last}")

    def _read(self):
        for line in self._process.stdout:
            found = _READY.match(line)
            if found:
                self.url = found[1]
                self._ready.set()
        self._ready.set()

    def _last_lines(self, count=20):
        self._log.seek(0)
        return "".join(self._log.readlines()[-count:])

    @property
    def pid(self) -> int:
        return self._process.pid

    def connect(self, **options) -> blocking.Water:
        """A client of this server; the options are those of `connect`."""
        return blocking.connect(self.url, **options)

    def stop(self):
        """Ends the server and waits for it; kills it after 30 s."""
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGINT)
            try:
                self._process.wait(_END_WITHIN_S)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        self._reading.join()
        self._process.stdout.close()
        self._log.close()

    def __enter__(self) -> "Server":
        return self

    def __exit__(self, *_):
        self.stop()


@contextlib.contextmanager
def serve(scene: str = "", *, options: Sequence[str] = (), program: str = "", environment: dict | None = None, **client) -> Iterator[blocking.Water]:
    """Starts a server, gives a client of it, and ends both: `with spindrift.serve("harbor") as water:`. The arguments are those of Server;
    all others are those of `connect`."""
    with Server(scene, options=options, program=program, environment=environment) as server, server.connect(**client) as water:
        yield water

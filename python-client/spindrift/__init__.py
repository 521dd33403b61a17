"""Client of the Spindrift water server.

    import spindrift
    with spindrift.connect("http://localhost:8080") as water:
        print(water.surface().heights_m.max())

`connect` gives calls that wait; `aio.connect` is the same for asyncio; `serve` starts a server of one's own. docs/python.md of the
project has examples."""
from . import aio
from .aio import Event
from .blocking import Clock, Water, connect
from .errors import ConnectionLost, Damaged, NoAnswer, Refused, Rejected, ServerFailed, SpindriftError
from .frames import Boats, Floaters, Foam, Frame, Particles, Plane, Surface
from .gauges import GaugeSeries
from .hulls import HullForces, Wrenches
from .queries import Answer
from .server import Server, serve

__all__ = ["Answer", "Boats", "Clock", "ConnectionLost", "Damaged", "Event", "Floaters", "Foam", "Frame", "GaugeSeries", "HullForces", "NoAnswer",
           "Particles", "Plane", "Refused", "Rejected", "Server", "ServerFailed", "SpindriftError", "Surface", "Water", "Wrenches", "aio", "connect",
           "serve"]

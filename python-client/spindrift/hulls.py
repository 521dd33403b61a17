"""What the water does to boats that this client moves (move_boat)."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .v1 import wire_pb2 as wire


@dataclass(frozen=True)
class Wrenches:
    """One force and moment per hull, arrays float64 [count, 3]."""

    force_n: np.ndarray
    """Along x, y and z of the water."""
    moment_nm: np.ndarray
    """About the hull's centre: roll (positive lowers starboard), pitch (positive lifts the bow), yaw (positive turns from +x toward +z)."""

    @staticmethod
    def of(wrenches) -> "Wrenches":
        rows = np.array([[w.force_x_n, w.force_y_n, w.force_z_n, w.moment_roll_nm, w.moment_pitch_nm, w.moment_yaw_nm] for w in wrenches], float).reshape(-1, 6)
        return Wrenches(rows[:, :3], rows[:, 3:])


@dataclass(frozen=True)
class HullForces:
    """What the water did to the moved hulls in `tick`, as a mean over it. Weight, thrust and the boats' mass are not in it."""

    tick: int
    time_s: float
    """Simulation time since the scene began or was reset."""
    state_id: int
    """As of frames: those with the same number show the same water."""
    boat_ids: np.ndarray
    """uint32 [count]; the rows of the forces."""
    hydrostatic: Wrenches
    """Buoyancy of the submerged hull under the still surface around it."""
    dynamic: Wrenches
    """Pressure of waves, the dent of the hull itself included."""
    drag: Wrenches
    """Resistance against the moving water."""

    @staticmethod
    def of(message: wire.HullForces) -> "HullForces":
        parts = (Wrenches.of([getattr(hull, name) for hull in message.hulls]) for name in ("hydrostatic", "dynamic", "drag"))
        return HullForces(message.tick, message.time_s, message.state_id, np.array([hull.boat_id for hull in message.hulls], np.uint32), *parts)

    def index_of(self, boat_id: int) -> int | None:
        """The row of a boat; None if this has no forces on it."""
        found = np.flatnonzero(self.boat_ids == boat_id)
        return int(found[0]) if len(found) else None

    @property
    def total(self) -> Wrenches:
        """The sum of the three."""
        parts = (self.hydrostatic, self.dynamic, self.drag)
        return Wrenches(sum(part.force_n for part in parts), sum(part.moment_nm for part in parts))

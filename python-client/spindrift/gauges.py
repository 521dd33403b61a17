"""What a gauge measured."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class GaugeSeries:
    """Arrays with one entry per tick, oldest first."""

    name: str
    x_m: float
    z_m: float
    time_s: np.ndarray
    """Simulation time since the scene began or was reset."""
    elevation_m: np.ndarray
    """Over the water at rest."""
    velocity_x_mps: np.ndarray
    """Of the flow, as a mean over its depth."""
    velocity_z_mps: np.ndarray

    @staticmethod
    def of(message) -> "GaugeSeries":
        columns = (np.array(getattr(message, name), float) for name in ("time_s", "elevation_m", "velocity_x_mps", "velocity_z_mps"))
        return GaugeSeries(message.name, message.x_m, message.z_m, *columns)

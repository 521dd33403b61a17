"""The water at points."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .v1 import wire_pb2 as wire


@dataclass(frozen=True)
class Answer:
    """The water at the points of a query, after `tick`: arrays float32 [count], in the order of the points. Of elevation, speeds and
    slopes only wet cells count; on dry ground alone elevation_m is that of the ground where water can come, and otherwise 0."""

    tick: int
    time_s: float
    """Simulation time since the scene began or was reset."""
    state_id: int
    """As of frames: those with the same number show the same water."""
    elevation_m: np.ndarray
    """Over the water at rest."""
    vertical_speed_mps: np.ndarray
    """Rate at which the elevation at the position changes."""
    velocity_x_mps: np.ndarray
    """Of the water, as a mean over its depth."""
    velocity_z_mps: np.ndarray
    slope_x: np.ndarray
    """Of the elevation along x."""
    slope_z: np.ndarray
    depth_m: np.ndarray
    """From the bed to the surface."""
    wet_ratio: np.ndarray
    """Share of wet cells around the point."""
    foam_ratio: np.ndarray
    """Share of white water."""
    outside: np.ndarray
    """Whether the point lies outside of the water, bool [count]; its values are 0."""

    @staticmethod
    def of(answer: wire.QueryAnswer, result: wire.QueryResult) -> "Answer":
        outside = np.zeros(len(result.elevation_m), bool)
        outside[list(result.outside)] = True
        return Answer(answer.tick, answer.time_s, answer.state_id, *(np.array(getattr(result, name), np.float32) for name in VALUES), outside)


VALUES = ("elevation_m", "vertical_speed_mps", "velocity_x_mps", "velocity_z_mps", "slope_x", "slope_z", "depth_m", "wet_ratio", "foam_ratio")


def fields(points, velocities=None) -> dict:
    """The fields of a Query. Raises ValueError for shapes that do not fit."""
    points = np.asarray(points, np.float32)
    if points.ndim != 2 or points.shape[1] != 2 or not len(points):
        raise ValueError(f"points have the shape {points.shape}; they have to be [count, 2], x and z in metres, at least one")
    out = {"x_m": points[:, 0].tolist(), "z_m": points[:, 1].tolist()}
    if velocities is not None:
        velocities = np.atleast_2d(np.asarray(velocities, np.float32))
        if velocities.shape not in ((1, 2), points.shape):
            raise ValueError(f"velocities have the shape {velocities.shape}; they have to be [2] for all points, or {points.shape}")
        out |= {"velocity_x_mps": velocities[:, 0].tolist(), "velocity_z_mps": velocities[:, 1].tolist()}
    return out

"""Frames as numpy arrays, in metres, seconds and radians. x and z lie level, y points up, y = 0 is the water at rest."""
from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from . import codec
from .errors import Damaged
from .v1 import wire_pb2 as wire

LAYERS = {name.removeprefix("LAYER_").lower(): number for name, number in wire.Layer.items() if number}

_MAX_RESOLUTION_COUNT = 4096
_MAX_PARTICLE_COUNT = 4 * 1024 * 1024
_MAX_RECORD_COUNT = 1024
_MAX_POSITION_COUNT = 65536
_MAX_CELL_COUNT = 2**24
_LARGEST = 1e6
"""Largest size, position or speed on the wire [m, m/s]."""


@dataclass(frozen=True)
class Frame:
    """The state of a room after `tick`, one layer of it."""

    tick: int
    state_id: int
    """Frames with the same number show the same state, whatever their layer."""
    time_s: float
    """Simulation time since the scene began or was reset."""
    server_time_s: float
    level: str
    """Level of detail: coarse, medium, fine or full."""


@dataclass(frozen=True)
class Plane(Frame):
    """Samples at the centres of cells: sample [k, i] lies at x_m[i], z_m[k]."""

    length_m: float
    """Extent along x."""
    width_m: float
    """Extent along z."""
    samples: np.ndarray
    """[count_z, count_x], as they are on the wire."""

    @cached_property
    def x_m(self) -> np.ndarray:
        """[count_x]"""
        return _centres(self.samples.shape[1], self.length_m)

    @cached_property
    def z_m(self) -> np.ndarray:
        """[count_z]"""
        return _centres(self.samples.shape[0], self.width_m)


@dataclass(frozen=True)
class Surface(Plane):
    quantum_m: float
    """The samples are whole numbers of it, int16."""

    @cached_property
    def heights_m(self) -> np.ndarray:
        """Elevation over the water at rest, float32 [count_z, count_x]; on dry ground that of the ground. Its error is at most
        half of quantum_m."""
        return (self.samples * self.quantum_m).astype(np.float32)

    def height_m(self, x_m, z_m) -> np.ndarray:
        """Elevation at positions, bilinear between samples, as at the outermost sample beyond it. `x_m`, `z_m`: numbers or arrays
        of one shape; the result has it too."""
        i, u = _place(np.asarray(x_m, float), self.x_m)
        k, v = _place(np.asarray(z_m, float), self.z_m)
        h, right, below = self.heights_m, np.minimum(i + 1, self.samples.shape[1] - 1), np.minimum(k + 1, self.samples.shape[0] - 1)
        return (1 - v) * ((1 - u) * h[k, i] + u * h[k, right]) + v * ((1 - u) * h[below, i] + u * h[below, right])


@dataclass(frozen=True)
class Foam(Plane):
    @cached_property
    def white(self) -> np.ndarray:
        """Share of white water, 0 to 1, float32 [count_z, count_x]."""
        return (self.samples / 255.0).astype(np.float32)


@dataclass(frozen=True)
class Particles(Frame):
    positions_m: np.ndarray
    """float32 [count, 3], x, y, z; in any order, which may differ from frame to frame."""
    velocities_mps: np.ndarray
    """float32 [count, 3]"""
    density_ratio: np.ndarray
    """Density over that at rest, float32 [count]."""
    foam: np.ndarray
    """0 clear to 1 white, float32 [count]."""
    radius_m: float
    """Half the spacing at rest."""


@dataclass(frozen=True)
class Boats(Frame):
    """Arrays with one entry for each boat."""

    ids: np.ndarray
    """uint32 [count]"""
    positions_m: np.ndarray
    """float64 [count, 3], of the middle between keel and deck."""
    heading_rad: np.ndarray
    """From +x toward +z."""
    pitch_rad: np.ndarray
    """Positive lifts the bow."""
    roll_rad: np.ndarray
    """Positive lowers starboard, the +z side at heading 0."""
    speed_mps: np.ndarray
    """Along the heading."""
    throttle_ratio: np.ndarray
    rudder_ratio: np.ndarray

    def index_of(self, boat_id: int) -> int | None:
        """Index of a boat in the arrays, None if it is not there (yet)."""
        found = np.flatnonzero(self.ids == boat_id)
        return int(found[0]) if found.size else None


@dataclass(frozen=True)
class Floaters(Frame):
    """Objects in the water: arrays with one entry for each."""

    ids: np.ndarray
    """uint32 [count]"""
    positions_m: np.ndarray
    """float64 [count, 3], of the middle."""
    rotations: np.ndarray
    """Unit quaternions x, y, z, w, float64 [count, 4]: from the object's own axes (x along it, y up, z across) to those of the water."""
    sizes_m: np.ndarray
    kinds: np.ndarray
    """FloaterKind, uint8 [count]."""
    held: np.ndarray
    """Whether somebody holds it, bool [count]."""


class FrameReader:
    """LayerFrame messages of one subscription to frames. Packed ones build on the frames before, so it needs all of them."""

    def __init__(self):
        self._readers: dict[int, codec.Reader] = {}
        self._ticks: dict[int, int] = {}

    def forget(self, layer: int):
        """After a new subscription: a keyframe comes first."""
        self._ticks.pop(layer, None)
        if layer in self._readers:
            self._readers[layer].forget()

    def read(self, frame: wire.LayerFrame) -> Frame:
        """Raises Damaged; then a new subscription is due, because deltas no longer have what they build on."""
        kind = frame.WhichOneof("codec")
        read = _READERS.get(kind)
        if read is None:
            raise Damaged(f"a frame of layer {frame.layer} in a codec that this client does not know: update it")
        layer, of = read
        if frame.layer != layer:
            raise Damaged(f"{kind} in a frame of layer {frame.layer}")
        if not (math.isfinite(frame.time_s) and math.isfinite(frame.server_time_s)):
            raise Damaged(f"{kind}: a time of {frame.time_s} s, server time {frame.server_time_s} s")
        crc = codec.crc32c(frame.payload)
        if crc != frame.crc32c:
            raise Damaged(f"{kind}: checksum 0x{crc:08x}, the frame says 0x{frame.crc32c:08x}")
        before = self._ticks.pop(layer, None)
        if not frame.keyframe:
            if kind not in _DELTAS:
                raise Damaged(f"a delta, but {kind} has only keyframes")
            if before is None or before != frame.base_tick:
                raise Damaged(f"{kind}: a delta on tick {frame.base_tick}, the last frame read is of {before}")
        reader = self._readers.setdefault(layer, codec.Reader())
        header = {"tick": frame.tick, "state_id": frame.state_id, "time_s": frame.time_s, "server_time_s": frame.server_time_s,
                  "level": _level_name(frame.level)}
        result = of(header, getattr(frame, kind), frame, reader)
        self._ticks[layer] = frame.tick
        return result


def _level_name(level):
    known = level in wire.Level.values()
    return wire.Level.Name(level).removeprefix("LEVEL_").lower() if known else "full"


def _centres(count, side_m):
    return (np.arange(count) + 0.5) * (side_m / count) - side_m / 2


def _place(at_m, centres_m):
    step_m = centres_m[1] - centres_m[0] if len(centres_m) > 1 else 1.0
    cells = np.clip((at_m - centres_m[0]) / step_m, 0.0, len(centres_m) - 1.0)
    index = np.minimum(cells.astype(int), max(len(centres_m) - 2, 0))
    return index, cells - index


def _require(holds, text):
    if not holds:
        raise Damaged(text)


def _is_size(value):
    return 0 < value <= _LARGEST


def _plain(frame, byte_count, what):
    _require(len(frame.payload) == byte_count, f"{what}: a payload of {len(frame.payload)} bytes, the header says {byte_count}")
    return frame.payload


def _extents(header):
    """count_x, count_z, length_m, width_m of a plane; what is left out along z is as along x."""
    count_x, count_z = header.resolution_count, header.count_z or header.resolution_count
    length_m, width_m = header.side_m, header.width_m or header.side_m
    for count in (count_x, count_z):
        _require(1 <= count <= _MAX_RESOLUTION_COUNT, f"a plane of {count} samples along an axis, allowed are 1 to {_MAX_RESOLUTION_COUNT}")
    for side_m in (length_m, width_m):
        _require(_is_size(side_m), f"a plane with a side of {side_m} m, which has to be above 0")
    return count_x, count_z, length_m, width_m


def _packed_plane(header, frame, reader):
    count_x, count_z, length_m, width_m = _extents(header)
    wanted = (codec.WEIGHT_COUNT,) * (2 if frame.keyframe else 1)
    found = (len(header.weights), len(header.earlier_weights))[: len(wanted)]
    _require(found == wanted, f"a plane with {found} weights, there have to be {wanted}")
    samples = reader.plane(frame.payload, count_x, count_z, header.weights, header.earlier_weights if frame.keyframe else None)
    return {"length_m": length_m, "width_m": width_m, "samples": samples}


def _plain_plane(header, frame, dtype):
    count_x, count_z, length_m, width_m = _extents(header)
    payload = _plain(frame, count_x * count_z * np.dtype(dtype).itemsize, "a plane")
    return {"length_m": length_m, "width_m": width_m, "samples": np.frombuffer(payload, dtype).reshape(count_z, count_x)}


def _quantum(quantum_m):
    _require(_is_size(quantum_m), f"a surface with a quantum of {quantum_m} m, which has to be above 0")
    return quantum_m


def _surface(header, plane, frame, _reader):
    return Surface(**header, **_plain_plane(plane, frame, "<i2"), quantum_m=_quantum(plane.quantum_m))


def _packed_surface(header, plane, frame, reader):
    return Surface(**header, quantum_m=_quantum(plane.quantum_m), **_packed_plane(plane, frame, reader))


def _foam(header, plane, frame, _reader):
    return Foam(**header, **_plain_plane(plane, frame, np.uint8))


def _packed_foam(header, plane, frame, reader):
    values = _packed_plane(plane, frame, reader)
    return Foam(**header, **(values | {"samples": np.clip(values["samples"], 0, 255).astype(np.uint8)}))


_PARTICLE = np.dtype([("x", "<u2"), ("z", "<u2"), ("y", "<u2"), ("velocity", "i1", 3), ("tint", "u1"), ("foam", "u1"), ("zero", "u1")])


def _particle_arrays(header, records, min_m, per_word_m, per_step_mps, radius_m):
    words = np.frombuffer(records, _PARTICLE)
    positions = np.stack([words[axis] for axis in "xyz"], axis=1) * np.asarray(per_word_m) + np.asarray(min_m)
    return Particles(**header, positions_m=positions.astype(np.float32), velocities_mps=(words["velocity"] * per_step_mps).astype(np.float32),
                     density_ratio=(0.5 + words["tint"] * (0.6 / 255)).astype(np.float32), foam=(words["foam"] / 255.0).astype(np.float32),
                     radius_m=radius_m)


def _check_particles(count, radius_m, speed_mps):
    _require(count <= _MAX_PARTICLE_COUNT, f"{count} particles, at most {_MAX_PARTICLE_COUNT} are taken")
    _require(_is_size(radius_m), f"particles with a radius of {radius_m} m, which has to be above 0")
    _require(0 <= speed_mps <= _LARGEST, f"particles with a bound of {speed_mps} m/s")


def _particles(header, codec_header, frame, _reader):
    h = codec_header
    low, high = (h.min_x_m, h.min_y_m, h.min_z_m), (h.max_x_m, h.max_y_m, h.max_z_m)
    _check_particles(h.count, h.radius_m, h.max_speed_mps)
    _require(all(-_LARGEST <= a <= b <= _LARGEST for a, b in zip(low, high)), f"particles between {low} and {high} m")
    records = _plain(frame, h.count * codec.PARTICLE_BYTES, "particles")
    per_word_m = [(b - a) / 65535 for a, b in zip(low, high)]
    return _particle_arrays(header, records, low, per_word_m, h.max_speed_mps / 127, h.radius_m)


def _packed_particles(header, codec_header, frame, _reader):
    h = codec_header
    cells, low = (h.cells_x_count, h.cells_y_count, h.cells_z_count), (h.min_x_m, h.min_y_m, h.min_z_m)
    _check_particles(h.count, h.radius_m, h.velocity_quantum_mps)
    _require(1 <= h.offset_bits <= 8, f"particles with {h.offset_bits} bits of offset")
    _require(all(1 <= n <= _MAX_POSITION_COUNT >> h.offset_bits for n in cells) and math.prod(cells) <= _MAX_CELL_COUNT,
             f"particles in {cells} cells")
    _require(all(abs(a) <= _LARGEST for a in low) and _is_size(h.cell_m), f"particles from {low} m on in cells of {h.cell_m} m")
    records = codec.particles(frame.payload, h.count, cells, h.offset_bits)
    quantum_m = h.cell_m / 2**h.offset_bits
    return _particle_arrays(header, records, [a + quantum_m / 2 for a in low], quantum_m, h.velocity_quantum_mps, h.radius_m)


_BOAT = np.dtype([("id", "<u4"), ("place", "<i4", 3), ("angle", "<i2", 3), ("speed", "<i2"), ("control", "i1", 2), ("zero", "<u2")])


def _boats(header, codec_header, frame, _reader):
    count = codec_header.count
    _require(count <= _MAX_RECORD_COUNT, f"{count} boats, at most {_MAX_RECORD_COUNT} are taken")
    boats = np.frombuffer(_plain(frame, count * _BOAT.itemsize, "boats"), _BOAT)
    angles, control = boats["angle"] * (math.pi / 32767), np.maximum(boats["control"] / 127.0, -1.0)
    return Boats(**header, ids=boats["id"], positions_m=boats["place"] * 1e-3, heading_rad=angles[:, 0], pitch_rad=angles[:, 1],
                 roll_rad=angles[:, 2], speed_mps=boats["speed"] * 1e-2, throttle_ratio=control[:, 0], rudder_ratio=control[:, 1])


_FLOATER = np.dtype([("id", "<u4"), ("place", "<i4", 3), ("turn", "<i2", 4), ("size", "<u2"), ("kind", "u1"), ("flags", "u1")])


def _floater_arrays(header, records, quantum_m):
    floaters = np.frombuffer(records, _FLOATER)
    turns = floaters["turn"].astype(float)
    lengths = np.linalg.norm(turns, axis=1, keepdims=True)
    _require(bool(np.all(lengths > 0)), "a floater without a rotation")
    return Floaters(**header, ids=floaters["id"], positions_m=floaters["place"] * quantum_m, rotations=turns / lengths,
                    sizes_m=floaters["size"] * 1e-2, kinds=floaters["kind"], held=(floaters["flags"] & 1).astype(bool))


def _check_floater_count(count):
    _require(count <= _MAX_RECORD_COUNT, f"{count} floaters, at most {_MAX_RECORD_COUNT} are taken")


def _floaters(header, codec_header, frame, _reader):
    _check_floater_count(codec_header.count)
    return _floater_arrays(header, _plain(frame, codec_header.count * codec.FLOATER_BYTES, "floaters"), 1e-3)


def _packed_floaters(header, codec_header, frame, reader):
    h = codec_header
    _check_floater_count(h.count)
    _require(1e-6 <= h.quantum_m <= 0.05, f"floaters in quanta of {h.quantum_m} m")
    _require(6 <= h.rotation_bits <= 13, f"floaters with {h.rotation_bits} bits of rotation")
    _require(h.motion_weight <= 512, f"floaters with a motion weight of {h.motion_weight}")
    records = reader.floaters(frame.payload, h.count, h.rotation_bits, h.motion_weight, frame.keyframe)
    return _floater_arrays(header, records, h.quantum_m)


# By the member of LayerFrame.codec: the layer that may carry it, and what reads it.
_READERS = {
    "surface_fixed16": (wire.LAYER_SURFACE, _surface),
    "surface_predicted": (wire.LAYER_SURFACE, _packed_surface),
    "foam_fixed8": (wire.LAYER_FOAM, _foam),
    "foam_predicted": (wire.LAYER_FOAM, _packed_foam),
    "particles_fixed12": (wire.LAYER_PARTICLES, _particles),
    "particles_by_cell": (wire.LAYER_PARTICLES, _packed_particles),
    "bodies_fixed28": (wire.LAYER_BODIES, _boats),
    "floaters_fixed28": (wire.LAYER_FLOATERS, _floaters),
    "floaters_predicted": (wire.LAYER_FLOATERS, _packed_floaters),
}
_DELTAS = ("surface_predicted", "foam_predicted", "floaters_predicted")

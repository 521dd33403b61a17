"""Packed frames to plain samples, by the project's own decoder (server/bitstream/c/spindrift_decoder.h)."""
import ctypes
import pathlib

import numpy as np

from .errors import Damaged

_LIBRARY = ctypes.CDLL(str(pathlib.Path(__file__).with_name("libspindrift_decoder.so")))
_LIBRARY.spindrift_reader_new.restype = ctypes.c_void_p
_LIBRARY.spindrift_crc32c.restype = ctypes.c_uint32
_LIBRARY.spindrift_crc32c.argtypes = [ctypes.c_char_p, ctypes.c_size_t]
_U32 = ctypes.c_uint32
_PAYLOAD = [ctypes.c_char_p, ctypes.c_size_t]
_LIBRARY.spindrift_reader_delete.argtypes = _LIBRARY.spindrift_reader_forget.argtypes = [ctypes.c_void_p]
_LIBRARY.spindrift_read_plane.argtypes = [ctypes.c_void_p, *_PAYLOAD, _U32, _U32, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p]
_LIBRARY.spindrift_read_floaters.argtypes = [ctypes.c_void_p, *_PAYLOAD, _U32, _U32, _U32, ctypes.c_int, ctypes.c_void_p]
_LIBRARY.spindrift_read_particles.argtypes = [*_PAYLOAD, _U32, _U32, _U32, _U32, _U32, ctypes.c_void_p]

FLOATER_BYTES = 28
PARTICLE_BYTES = 12
WEIGHT_COUNT = 10


def crc32c(payload: bytes) -> int:
    """The checksum of LayerFrame.crc32c; 0xE3069283 for b"123456789"."""
    return _LIBRARY.spindrift_crc32c(payload, len(payload))


class Reader:
    """The packed frames of one layer, in the order in which they arrive. Raises Damaged where a frame cannot be read."""

    def __init__(self):
        self._reader = _LIBRARY.spindrift_reader_new()
        if not self._reader:
            raise MemoryError("no memory for a reader of packed frames")

    def __del__(self):
        if getattr(self, "_reader", None):
            _LIBRARY.spindrift_reader_delete(self._reader)

    def forget(self):
        """Only a keyframe can follow."""
        _LIBRARY.spindrift_reader_forget(self._reader)

    def plane(self, payload, count_x, count_z, weights, earlier_weights):
        """int16 [count_z, count_x]. `earlier_weights`: of a keyframe; None for a delta."""
        samples = np.empty((count_z, count_x), np.int16)
        now = np.array(weights, np.int32)
        earlier = None if earlier_weights is None else np.array(earlier_weights, np.int32)
        if not _LIBRARY.spindrift_read_plane(self._reader, payload, len(payload), count_x, count_z, now.ctypes.data,
                                             None if earlier is None else earlier.ctypes.data, samples.ctypes.data):
            raise Damaged("a packed plane: its payload is damaged, or the frame that it builds on is missing")
        return samples

    def floaters(self, payload, count, rotation_bits, motion_weight, keyframe):
        """Records of FLOATER_BYTES bytes."""
        records = np.empty(count * FLOATER_BYTES, np.uint8)
        if not _LIBRARY.spindrift_read_floaters(self._reader, payload, len(payload), count, rotation_bits, motion_weight, keyframe,
                                                records.ctypes.data):
            raise Damaged("packed floaters: their payload is damaged, or the frame that they build on is missing")
        return records.tobytes()


def particles(payload, count, cells, offset_bits):
    """Records of PARTICLE_BYTES bytes. `cells`: counts along x, y, z."""
    records = np.empty(count * PARTICLE_BYTES, np.uint8)
    if not _LIBRARY.spindrift_read_particles(payload, len(payload), count, *cells, offset_bits, records.ctypes.data):
        raise Damaged(f"packed particles: the payload does not hold {count} of them")
    return records.tobytes()

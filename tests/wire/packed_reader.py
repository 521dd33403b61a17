#!/usr/bin/env python3
"""A reader of frames in one long file, because it is written from proto/README.md alone, with nothing of this project's code.

    packed_reader.py FOLDER     reads every case of FOLDER/golden.json and compares

Prints one line a case that differs, then a total; exits with 1 where one differs. What the README leaves unclear shows here.
"""
import json
import math
import pathlib
import struct
import sys

CODES = json.loads((pathlib.Path(__file__).resolve().parents[2] / "proto" / "packed_codes.json").read_text())


class Damaged(Exception):
    """The message or frame must be dropped; the text gives the reason."""


# ---- Protobuf, as far as the wire needs it (protobuf.dev, "Encoding") ------------------------------------------------


def fields_of(data):
    """Yields (number, value) of each field: an int for varints, bytes for the rest."""
    at, out = 0, []

    def varint():
        nonlocal at
        value = 0
        for shift in range(0, 70, 7):
            if at >= len(data):
                raise Damaged("a number is cut")
            byte = data[at]
            at += 1
            value |= (byte & 0x7F) << shift
            if byte < 0x80:
                return value & (2**64 - 1)
        raise Damaged("a number of more than 64 bits")

    while at < len(data):
        key = varint()
        number, kind = key >> 3, key & 7
        if number == 0 or kind not in (0, 1, 2, 5):
            raise Damaged("no field begins here")
        if kind == 0:
            out.append((number, varint()))
            continue
        size = {1: 8, 5: 4}.get(kind)
        size = varint() if size is None else size
        if size > len(data) - at:
            raise Damaged("a field is cut")
        out.append((number, data[at : at + size]))
        at += size
    return out


# Name and type of the fields that are read, by number; from wire.proto.
DOUBLE, UINT, SINTS, FIXED32, BYTES = "double", "uint", "sints", "fixed32", "bytes"
GRID = {1: ("resolution_count", UINT), 2: ("side_m", DOUBLE)}


def along_z(first):
    """What the headers of planes that are not squares have besides; 0 is as along x."""
    return {first: ("count_z", UINT), first + 1: ("width_m", DOUBLE)}


CODECS = {
    8: ("surface_fixed16", {**GRID, 3: ("quantum_m", DOUBLE), **along_z(4)}),
    9: ("particles_fixed12", {1: ("count", UINT), **{i + 2: (f"{m}_{a}_m", DOUBLE) for i, (m, a) in enumerate(
        (m, a) for m in ("min", "max") for a in "xyz")}, 8: ("max_speed_mps", DOUBLE), 9: ("radius_m", DOUBLE)}),
    10: ("foam_fixed8", {**GRID, **along_z(3)}),
    11: ("bodies_fixed28", {1: ("count", UINT)}),
    12: ("surface_predicted", {**GRID, 3: ("quantum_m", DOUBLE), 4: ("weights", SINTS), 5: ("earlier_weights", SINTS),
                               **along_z(6)}),
    13: ("particles_by_cell", {1: ("count", UINT), 2: ("min_x_m", DOUBLE), 3: ("min_y_m", DOUBLE), 4: ("min_z_m", DOUBLE),
                               5: ("cells_x_count", UINT), 6: ("cells_y_count", UINT), 7: ("cells_z_count", UINT),
                               8: ("cell_m", DOUBLE), 9: ("offset_bits", UINT), 10: ("velocity_quantum_mps", DOUBLE),
                               11: ("radius_m", DOUBLE)}),
    18: ("floaters_fixed28", {1: ("count", UINT)}),
    19: ("floaters_predicted", {1: ("count", UINT), 2: ("quantum_m", DOUBLE), 3: ("rotation_bits", UINT),
                                4: ("motion_weight", UINT)}),
    14: ("foam_predicted", {**GRID, 3: ("weights", SINTS), 4: ("earlier_weights", SINTS), **along_z(5)}),
}
FRAME = {1: ("layer", UINT), 2: ("tick", UINT), 3: ("time_s", DOUBLE), 4: ("keyframe", UINT), 5: ("base_tick", UINT),
         6: ("crc32c", FIXED32), 7: ("level", UINT), 15: ("payload", BYTES), 16: ("server_time_s", DOUBLE),
         17: ("state_id", UINT)}
LAYERS = {"surface": 1, "particles": 2, "bodies": 3, "foam": 4, "floaters": 6}
OBJECTS = ("bodies_fixed28", "floaters_fixed28")
COUNTED = (*OBJECTS, "floaters_predicted")
FLOATER_KINDS = ("CRATE", "BALL", "BARREL", "PLANK", "DUCK", "BUOY", "RAFT", "STONE")
KINDS = range(1, 16)  # of ServerMessage
FRAME_KIND = 2


def message_of(data, known):
    out = {name: {DOUBLE: 0.0, UINT: 0, SINTS: [], FIXED32: 0, BYTES: b""}[kind] for name, kind in known.values()}
    for number, value in fields_of(data):
        if number not in known:
            continue
        name, kind = known[number]
        if isinstance(value, int) != (kind == UINT):
            raise Damaged(f"{name} has another type")
        if kind == DOUBLE:
            value = struct.unpack("<d", value)[0]
        elif kind == FIXED32:
            value = struct.unpack("<I", value)[0]
        elif kind == SINTS:  # packed varints, zigzag
            value = out[name] + [(raw >> 1) ^ -(raw & 1) for raw in unpacked(value)]
        out[name] = value
    return out


def unpacked(data):
    value, shift, out = 0, 0, []
    for byte in data:
        value |= (byte & 0x7F) << shift
        shift += 7
        if byte < 0x80:
            out.append(value & 0xFFFFFFFF)
            value = shift = 0
    if shift:
        raise Damaged("a list of numbers is cut")
    return out


def frame_of(data):
    """Returns the LayerFrame of a ServerMessage with its codec's name and header; None for a message of another kind."""
    kinds = [(number, value) for number, value in fields_of(data) if number in KINDS]
    if not kinds:
        raise Damaged("no known kind of message")
    number, value = kinds[-1]
    if number != FRAME_KIND:
        fields_of(value)
        return None
    frame = message_of(value, FRAME)
    frame["codec"] = None
    for number, header in fields_of(value):
        if number in CODECS:
            frame["codec"], known = CODECS[number]
            frame["header"] = message_of(header, known)
    if frame["codec"] is None:
        raise Damaged("a codec that is not known")
    return frame


# ---- "What a client checks" --------------------------------------------------------------------------------------------


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x82F63B78 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF


def must(holds, what):
    if not holds:
        raise Damaged(what)


def check_header(frame):
    codec, h = frame["codec"], frame["header"]
    must(frame["layer"] == LAYERS[codec.split("_")[0]], "the codec of another layer")
    must(math.isfinite(frame["time_s"]) and math.isfinite(frame["server_time_s"]), "a time that is not finite")
    for name, value in h.items():
        if isinstance(value, float):
            must(math.isfinite(value) and abs(value) <= 1e6, f"{name} is {value}")
    for name, least in (("side_m", 1e-6), ("cell_m", 1e-6), ("quantum_m", 1e-9), ("radius_m", 0), ("max_speed_mps", 0),
                        ("velocity_quantum_mps", 0)):
        must(h.get(name, least) >= least, f"{name} is below {least}")
    must(1 <= h.get("resolution_count", 1) <= 4096, "resolution_count")
    if "resolution_count" in h:
        h["count_z"] = h["count_z"] or h["resolution_count"]
        h["width_m"] = h["width_m"] or h["side_m"]
        must(h["count_z"] <= 4096, "count_z")
        must(h["width_m"] >= 1e-6, "width_m")
    must(h.get("count", 0) <= (1024 if codec in COUNTED else 4_194_304), "count")
    if codec == "particles_fixed12":
        must(all(h[f"min_{a}_m"] <= h[f"max_{a}_m"] for a in "xyz"), "a minimum above its maximum")
    if codec == "particles_by_cell":
        cells = [h[f"cells_{a}_count"] for a in "xyz"]
        must(1 <= h["offset_bits"] <= 8, "offset_bits")
        must(all(1 <= c <= 2 ** (16 - h["offset_bits"]) for c in cells) and math.prod(cells) <= 2**24, "cells")
    predicted = codec.endswith("_predicted")
    must(predicted or frame["keyframe"], "no keyframe")
    if codec == "floaters_predicted":
        must(1e-6 <= h["quantum_m"] <= 0.05, "quantum_m")
        must(6 <= h["rotation_bits"] <= 13, "rotation_bits")
        must(h["motion_weight"] <= 512, "motion_weight")
    elif predicted:
        must(len(h["weights"]) == 10, "weights")
        must(not frame["keyframe"] or len(h["earlier_weights"]) == 10, "earlier_weights")
    bytes_each = {"surface_fixed16": 2, "foam_fixed8": 1, "particles_fixed12": 12, **dict.fromkeys(OBJECTS, 28)}.get(codec)
    if bytes_each:
        elements = h["count"] if "count" in h else h["resolution_count"] * h["count_z"]
        must(len(frame["payload"]) == bytes_each * elements, "the payload's length")
    must(crc32c(frame["payload"]) == frame["crc32c"], "the checksum")


# ---- "Packed frames" ---------------------------------------------------------------------------------------------------


class Bits:
    def __init__(self, payload):
        self.value, self.left = int.from_bytes(payload, "little"), 8 * len(payload)

    def number(self, count):
        must(count <= self.left, "a read past the end")
        out = self.value & ((1 << count) - 1)
        self.value >>= count
        self.left -= count
        return out

    def symbol(self, code):
        word = length = 0
        while (length, word) not in code:
            must(length < 11, "no code word")
            word, length = word << 1 | self.number(1), length + 1
        return code[length, word]


def code_of(lengths):
    """(length, code word) → symbol."""
    must(max(lengths) <= 11 and sum(2 ** (11 - n) for n in lengths if n) == 2**11, "a code that is not complete")
    out, word = {}, 0
    for length in range(1, 12):
        word <<= 1
        for symbol, n in enumerate(lengths):
            if n == length:
                out[length, word] = symbol
                word += 1
    return out


RESIDUAL_CODES = {entry["class"]: code_of(entry["lengths"]) for entry in CODES["residual_codes"]}
LARGEST = {entry["class"]: entry["largest"] for entry in CODES["residual_codes"] if "largest" in entry}
CLASS_CODES = {entry["neighbours_of_class_0"]: code_of(entry["lengths"]) for entry in CODES["class_codes"]}


def int16(value):
    return (value + 2**15) % 2**16 - 2**15


class Residuals:
    def __init__(self, bits):
        self.bits, self.sum = bits, 0

    def group(self, n, l, a):
        """Returns the class and n residuals."""
        bits = self.bits
        zeros = (l == 0) + (a == 0)
        e = {2: 9, 1: l + a, 0: (l + a + 1) // 2}[zeros]
        s = bits.symbol(CLASS_CODES[zeros])
        c = 0 if s == 0 else bits.number(6) if s == 18 else e - 9 + s
        c = min(max(c, 0), 44)
        out = []
        if c <= 4:
            out = [0] * n
            for _ in range(c):
                place, negative = bits.number(6), bits.number(1)
                must(place < n and out[place] == 0, "a residual's place")
                out[place] = -1 if negative else 1
        elif c <= 12:
            together, base, low, escape = (4, 3, 1, 13) if c <= 9 else (2, 9, 4, 15)
            while len(out) < n:
                v = bits.symbol(RESIDUAL_CODES[c])
                if v == 81:
                    out += [self.single(escape) for _ in range(together)]
                else:
                    out += [v // base**k % base - low for k in range(together)]
            must(not any(out[n:]), "residuals beyond a group's end")
        else:
            out = [self.single(c) for _ in range(n)]
        self.sum += sum(out)
        return c, out[:n]

    def single(self, c):
        b = 0 if c <= 17 else (c - 16) // 2
        coded_as = c if c <= 17 else 16 + c % 2
        v, largest = self.bits.symbol(RESIDUAL_CODES[coded_as]), LARGEST[coded_as]
        if v == 2 * largest + 1:
            return int16(self.bits.number(16))
        return int16((v - largest) * 2**b + self.bits.number(b) - 2**b // 2)

    def end(self):
        must(self.bits.number(16) == self.sum % 2**16, "the sum of the residuals")
        must(self.bits.left < 8 and self.bits.value == 0, "bits behind the sum")


# ---- the codecs --------------------------------------------------------------------------------------------------------

CROSS = ((-1, 0), (1, 0), (0, -1), (0, 1))
DIAGONAL = ((-1, -1), (1, -1), (-1, 1), (1, 1))


def read_plane(residuals, counts, weights, before, earlier):
    """before, earlier: planes as lists of rows, or None."""
    nx, nz = counts
    plane = [[0] * nx for _ in range(nz)]

    def total(frame, x, z, places, reach=1):
        if frame is None:
            return 0
        at = lambda i, n: min(max(i, 0), n - 1)
        return sum(frame[at(z + reach * dz, nz)][at(x + reach * dx, nx)] for dx, dz in places)

    classes = {}
    for tz in range(0, nz, 8):
        for tx in range(0, nx, 8):
            width, height = min(8, nx - tx), min(8, nz - tz)
            c, values = residuals.group(width * height, classes.get((tx - 8, tz), 0), classes.get((tx, tz - 8), 0))
            classes[tx, tz] = c
            plane_part = iter(values)
            for z in range(tz, tz + height):
                for x in range(tx, tx + width):
                    plane[z][x] = next(plane_part)
    for z in range(nz):
        for x in range(nx):
            if z == 0:
                own = [plane[0][x - 1] if x > 0 else 0] * 3
            elif x == 0:
                own = [plane[z - 1][0]] * 3
            else:
                own = [plane[z][x - 1], plane[z - 1][x], plane[z - 1][x - 1]]
            here = ((0, 0),)
            terms = [total(before, x, z, here), total(before, x, z, CROSS), total(before, x, z, DIAGONAL),
                     total(before, x, z, CROSS, 2), total(earlier, x, z, here), total(earlier, x, z, CROSS),
                     total(earlier, x, z, DIAGONAL), *own]
            sum_32 = (2048 + sum(w * t for w, t in zip(weights, terms)) + 2**31) % 2**32 - 2**31
            plane[z][x] = int16(plane[z][x] + sum_32 // 4096)
    return plane


def floater_of(floater_id, position_m, rotation, size_cm, kind, flags):
    name = FLOATER_KINDS[kind - 1] if 1 <= kind <= len(FLOATER_KINDS) else "CRATE"
    return {"floater_id": floater_id, "position_m": position_m, "rotation": rotation, "size_m": size_cm / 100,
            "kind": f"FLOATER_KIND_{name}", "is_held": bool(flags & 1)}


class Reader:
    """The subscriptions of one client: keeps the planes that the next packed frame builds on."""

    def __init__(self):
        self.history = {}  # layer → (values that must stay the same, tick, last plane, the one before)

    def read(self, frame):
        check_header(frame)
        return getattr(self, frame["codec"])(frame, frame["header"])

    def predicted(self, frame, h):
        n = h["resolution_count"], h["count_z"]
        same = (frame["level"], *n, h["side_m"], h["width_m"], h.get("quantum_m"))
        known = self.history.pop(frame["layer"], None)
        residuals = Residuals(Bits(frame["payload"]))
        if frame["keyframe"]:
            plane = read_plane(residuals, n, h["weights"], None, None)
            before = read_plane(residuals, n, h["earlier_weights"], plane, None)
        else:
            must(known is not None and known[:2] == (same, frame["base_tick"]), "the frame before is not here")
            before = known[2]
            plane = read_plane(residuals, n, h["weights"], before, known[3])
        residuals.end()
        self.history[frame["layer"]] = (same, frame["tick"], plane, before)
        return [sample for row in plane for sample in row]

    def surface_predicted(self, frame, h):
        return {"elevation_m": [s * h["quantum_m"] for s in self.predicted(frame, h)]}

    def foam_predicted(self, frame, h):
        return {"foam": [min(max(s, 0), 255) for s in self.predicted(frame, h)]}

    def surface_fixed16(self, frame, h):
        samples = struct.unpack(f"<{h['resolution_count'] * h['count_z']}h", frame["payload"])
        return {"elevation_m": [s * h["quantum_m"] for s in samples]}

    def foam_fixed8(self, frame, h):
        return {"foam": list(frame["payload"])}

    def particles_fixed12(self, frame, h):
        out = {"position_m": [], "velocity_mps": [], "tint": [], "foam": []}
        for x, z, y, vx, vy, vz, tint, foam, _ in struct.iter_unpack("<HHHbbbBBB", frame["payload"]):
            for axis, value in zip("xyz", (x, y, z)):
                low, high = h[f"min_{axis}_m"], h[f"max_{axis}_m"]
                out["position_m"].append(low + value / 65535 * (high - low))
            out["velocity_mps"] += [v / 127 * h["max_speed_mps"] for v in (vx, vy, vz)]
            out["tint"].append(tint)
            out["foam"].append(foam)
        return out

    def bodies_fixed28(self, frame, h):
        boats = []
        for boat_id, x, y, z, *angles, speed, throttle, rudder, _ in struct.iter_unpack("<IiiihhhhbbH", frame["payload"]):
            must(boat_id != 0, "boat_id 0")
            heading, pitch, roll = (a / 32767 * math.pi for a in angles)
            boats.append({"boat_id": boat_id, "position_m": [x / 1000, y / 1000, z / 1000], "heading_rad": heading,
                          "pitch_rad": pitch, "roll_rad": roll, "speed_mps": speed / 100,
                          "throttle_ratio": max(throttle / 127, -1), "rudder_ratio": max(rudder / 127, -1)})
        return {"bodies": boats}

    def floaters_fixed28(self, frame, h):
        floaters = []
        for floater_id, x, y, z, *rotation, size, kind, flags in struct.iter_unpack("<IiiihhhhHBB", frame["payload"]):
            must(floater_id != 0, "floater_id 0")
            floaters.append(floater_of(floater_id, [x / 1000, y / 1000, z / 1000], [q / 32767 for q in rotation], size, kind, flags))
        return {"floaters": floaters}

    def floaters_predicted(self, frame, h):
        unit, weight = 2 ** h["rotation_bits"], h["motion_weight"]
        residuals = Residuals(Bits(frame["payload"]))
        same = (frame["level"], h["quantum_m"], h["rotation_bits"])
        known = self.history.pop(frame["layer"], None)

        def column(count):
            out, c = [], 0
            while len(out) < count:
                c, some = residuals.group(min(64, count - len(out)), c, c)
                out += some
            return out

        def within(values, low, high, what):
            must(all(low <= v <= high for v in values), what)
            return values

        def running(changes, modulus):
            total = 0
            return [total := (total + change) % modulus for change in changes]

        def set_derived(one):
            rest = unit * unit - sum(q * q for i, q in enumerate(one["turn"]) if i != one["derived"])
            must(rest >= 0, "parts longer than a unit quaternion")
            one["turn"][one["derived"]] = math.isqrt(rest)

        def others(one):
            return [i for i in range(4) if i != one["derived"]]

        def new_ones(count):
            low, high = column(count), column(count)
            ids = running([1 + 65536 * h_ + l_ for l_, h_ in zip(low, high)], 2**32)
            must(all(ids), "floater_id 0")
            sizes = running(column(count), 65536)
            kinds, kind = [], 0
            for change in column(count):
                kind += change
                kinds.append(kind)
            within(kinds, 1, 255, "kind")
            flags = within(column(count), 0, 255, "flags")
            places = []
            for _ in range(3):
                low, high = column(count), column(count)
                places.append(within([65536 * h_ + l_ for l_, h_ in zip(low, high)], -(2**24), 2**24, "a coordinate"))
            derived = within(column(count), 0, 3, "the part that is not sent")
            out = [{"id": i, "size": s, "kind": k, "flags": f, "place": list(p), "derived": d, "turn": [0] * 4,
                    "place_motion": [0] * 3, "turn_motion": [0] * 4}
                   for i, s, k, f, p, d in zip(ids, sizes, kinds, flags, zip(*places), derived)]
            for k in range(3):
                for one, part in zip(out, column(count)):
                    one["turn"][others(one)[k]] = part
            for one in out:
                set_derived(one)
            return out

        def goes_on(value, motion):
            return value + (motion * weight + 128) // 256

        if frame["keyframe"]:
            objects = new_ones(h["count"])
            for name, parts in (("place_motion", 3), ("turn_motion", 4)):
                for part in range(parts):
                    for one, change in zip(objects, column(h["count"])):
                        one[name][part] = change
        else:
            must(known is not None and known[:2] == (same, frame["base_tick"]), "the frame before is not here")
            gone = within(column(len(known[2])), 0, 1, "which objects go")
            is_new = within(column(h["count"]), 0, 1, "which objects come")
            before = [one for one, goes in zip(known[2], gone) if not goes]
            must(len(before) == is_new.count(0), "the number of objects that stay")
            fresh = new_ones(sum(is_new))
            stay = [{**one, "flags": one["flags"] ^ change}
                    for one, change in zip(before, within(column(len(before)), 0, 255, "flags"))]
            for one, step in zip(stay, within(column(len(before)), 0, 3, "the part that is not sent")):
                one["derived"] = (one["derived"] + step) % 4
                sign = -1 if one["turn"][one["derived"]] < 0 else 1
                one["turn_from"] = [sign * q for q in one["turn"]]
                one["turn_motion"] = [sign * m for m in one["turn_motion"]]
                one["turn"] = [0] * 4
            places = list(zip(*(column(len(before)) for _ in range(3)))) if before else []
            for one, residual in zip(stay, places):
                place = [goes_on(p, m) + r for p, m, r in zip(one["place"], one["place_motion"], residual)]
                within(place, -(2**24), 2**24, "a coordinate")
                one["place_motion"] = [a - b for a, b in zip(place, one["place"])]
                one["place"] = place
            for k in range(3):
                for one, residual in zip(stay, column(len(before))):
                    i = others(one)[k]
                    one["turn"][i] = int16(goes_on(one["turn_from"][i], one["turn_motion"][i]) + residual)
            for one in stay:
                set_derived(one)
                one["turn_motion"] = [a - b for a, b in zip(one["turn"], one.pop("turn_from"))]
            rows = {0: iter(stay), 1: iter(fresh)}
            objects = [next(rows[new]) for new in is_new]
        residuals.end()
        self.history[frame["layer"]] = (same, frame["tick"], objects)
        floaters = []
        for one in objects:
            length = math.hypot(*one["turn"])
            floaters.append(floater_of(one["id"], [p * h["quantum_m"] for p in one["place"]],
                                       [q / length for q in one["turn"]], one["size"], one["kind"], one["flags"]))
        return {"floaters": floaters}

    def particles_by_cell(self, frame, h):
        bits, count, offset_bits = Bits(frame["payload"]), h["count"], h["offset_bits"]
        cells_x, cells_y, cells_z = (h[f"cells_{a}_count"] for a in "xyz")

        def sent_code(symbols):  # part 1
            return code_of([bits.number(4) if s < 2 or bits.number(1) else 0 for s in range(symbols)])

        occupancy, gap = sent_code(256), sent_code(25)
        corners, at = [], -1  # part 2
        while len(corners) < count:
            g = bits.symbol(gap)
            at += 1 + (g if g < 2 else 2 ** (g - 1) + bits.number(g - 1))
            must(at < cells_x * cells_y * cells_z, "a cell beyond the last")
            cell = (at // cells_y % cells_x, at % cells_y, at // cells_y // cells_x)
            first, second = bits.symbol(occupancy), bits.symbol(occupancy)
            must(first or second, "an empty cell that is named")
            for eighth in range(8):
                held = (second << 8 | first) >> 2 * eighth & 3
                if held == 3:
                    k = 0
                    while bits.number(1) == 0:
                        k += 1
                    must(k <= 22, "a count's length")
                    held += 2**k + bits.number(k) - 1
                must(held <= count - len(corners), "more particles than there are")
                halves = (eighth >> 2, eighth & 1, eighth >> 1 & 1)  # x, y, z
                corners += [[c * 2**offset_bits + half * 2 ** (offset_bits - 1) for c, half in zip(cell, halves)]] * held
        out = {"position_m": [], "velocity_mps": [0.0] * (3 * count), "tint": [], "foam": []}
        for corner in corners:  # part 3
            x, z, y = (bits.number(offset_bits - 1) for _ in range(3))
            for axis, i in zip("xyz", (corner[0] + x, corner[1] + y, corner[2] + z)):
                out["position_m"].append(h[f"min_{axis}_m"] + (i + 0.5) * h["cell_m"] / 2**offset_bits)
        residuals, names = Residuals(bits), ("vx", "vy", "vz", "foam", "tint")  # part 4
        mean = dict.fromkeys(names, 0)
        classes = dict.fromkeys(((name, kind) for name in names for kind in ("mean", "differences")), 0)
        for begin in range(0, count, 64):
            n = min(64, count - begin)
            for name in names:
                c = classes[name, "mean"]
                classes[name, "mean"], (change,) = residuals.group(1, c, c)
                mean[name] = int16(mean[name] + change)
                c = classes[name, "differences"]
                classes[name, "differences"], differences = residuals.group(n, c, c)
                values = [int16(mean[name] + d) for d in differences]
                if name == "tint":
                    out["tint"] += [min(max(v, 0), 7) * 255 // 7 for v in values]
                elif name == "foam":
                    out["foam"] += [min(max(v, 0), 3) * 85 for v in values]
                else:
                    for i, v in enumerate(values):
                        out["velocity_mps"][3 * (begin + i) + names.index(name)] = min(max(v, -127), 127) * h["velocity_quantum_mps"]
        residuals.end()  # part 5
        return out


# ---- golden.json -------------------------------------------------------------------------------------------------------


def differs(found, wanted):
    """Returns where two JSON values differ, or None. 64-bit integers are strings; numbers have nine digits."""
    if isinstance(wanted, list):
        if len(found) != len(wanted):
            return f"{len(found)} instead of {len(wanted)}"
        return next((f"[{i}] {d}" for i, (f, w) in enumerate(zip(found, wanted)) if (d := differs(f, w))), None)
    if isinstance(wanted, dict):
        return next((f"{name} {d}" for name in wanted if (d := differs(found[name], wanted[name]))), None)
    if isinstance(wanted, str):
        return None if str(found) == wanted else f"{found} instead of {wanted}"
    same = math.isclose(found, wanted, rel_tol=1e-6, abs_tol=1e-6)
    return None if same else f"{found} instead of {wanted}"


def fault_of(case, folder, cases):
    """Returns what is wrong with this reader's result for a case, or None."""
    reader, chain = Reader(), [case]
    while chain[0].get("follows"):
        chain.insert(0, cases[chain[0]["follows"]])
    try:
        for one in chain:
            frame = frame_of((folder / one["file"]).read_bytes())
            found = reader.read(frame) if frame else None
    except Damaged as why:
        return None if case["verdict"] != "ok" else f"refused: {why}"
    if case["verdict"] != "ok":
        return "taken, but " + case["why"]
    if case["kind"] != "frame":
        return None if frame is None else "taken for a frame"
    found.update({name: frame[name] for name in ("tick", "time_s", "keyframe", "crc32c", "state_id")}, **frame["header"])
    names = [name for name in case if name not in ("file", "verdict", "kind", "follows", "packing", "layer")]
    return next((f"{name}: {d}" for name in names if (d := differs(found[name], case[name]))), None)


def main(folder):
    cases = {case["file"]: case for case in json.loads((folder / "golden.json").read_text())}
    faults = {file: fault for file, case in cases.items() if (fault := fault_of(case, folder, cases))}
    for file, fault in faults.items():
        print(f"{file}: {fault}")
    verdicts = [case["verdict"] for case in cases.values()]
    print(f"{len(cases)} cases ({', '.join(f'{verdicts.count(v)} {v}' for v in sorted(set(verdicts)))}), {len(faults)} differ")
    return 1 if faults else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(pathlib.Path(sys.argv[1])))

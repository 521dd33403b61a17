#!/usr/bin/env python3
"""Writes the seeds of the fuzz targets into a folder per target; long because it holds the text of every message and request.

Frames: sequences of golden messages that build on each other. Scenes and single golden messages are used as seeds without a
copy, see CMakeLists.txt.
"""

import argparse
import base64
import hashlib
import hmac
import json
import struct
import subprocess
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PROTO = ROOT / "proto"
parser = argparse.ArgumentParser(description="Writes the seeds of the fuzz targets (needs protoc).")
parser.add_argument("folder", type=Path)
FOLDER = parser.parse_args().folder

CLIENT_MESSAGES = {
    "hello": 'hello { version { major: 1 } client: "seed \\303\\251" }',
    "hello_other_major": 'hello { version { major: 2 minor: 7 } client: "seed" }',
    "subscribe_plain": "subscribe { layer: LAYER_SURFACE max_rate_hz: 30 }",
    "subscribe_packed": "subscribe { layer: LAYER_PARTICLES max_rate_hz: 240 packing: PACKING_PACKED }",
    "unsubscribe": "subscribe { layer: LAYER_FOAM }",
    "subscribe_nan": "subscribe { layer: LAYER_SURFACE max_rate_hz: nan }",
    "ping": "ping { client_time_s: 12.5 }",
    "ping_infinite": "ping { client_time_s: inf }",
    "splash": "command { command_id: 1 splash { x_m: 1 z_m: -1 radius_m: 1.2 depth_m: 0.3 duration_s: 0.2 } }",
    "splash_defaults": "command { command_id: 1 splash { } }",
    "splash_outside": "command { command_id: 2 splash { x_m: 1e5 } }",
    "splash_deep": "command { command_id: 3 splash { depth_m: 9 radius_m: 0.01 } }",
    "wave": "command { command_id: 4 breaking_wave { side: SIDE_MINUS_Z amplitude_m: 0.5 length_m: 3 duration_s: 0.5 } }",
    "swell": "command { command_id: 5 breaking_wave { side: SIDE_DIRECTION direction_deg: 30 shape: WAVE_SHAPE_SWELL } }",
    "parameter": 'command { command_id: 6 set_parameter { path: "particles.viscosity_pas" value: 20 } }',
    "parameter_depth": 'command { command_id: 7 set_parameter { path: "wave.depth_m" value: 0.3 } }',
    "parameter_restart": 'command { command_id: 8 set_parameter { path: "wave.resolution_count" value: 64 } }',
    "parameter_storm": 'command { command_id: 9 set_parameter { path: "storm.level_ratio" value: 0.5 } }',
    "parameter_unknown": 'command { command_id: 10 set_parameter { path: "wave.depth_m.deep" value: 1 } }',
    "parameter_nan": 'command { command_id: 11 set_parameter { path: "gravity_mps2" value: nan } }',
    "reset": "command { command_id: 12 reset { } }",
    "pause": "command { command_id: 13 set_paused { paused: true } }",
    "speed": "command { command_id: 14 set_speed { speed: 2 } }",
    "spawn_boat": "command { command_id: 15 spawn_boat { boat { x_m: 3 heading_deg: -90 length_m: 2.4 } } }",
    "spawn_boat_in_rock": "command { command_id: 16 spawn_boat { boat { x_m: 4 } } }",
    "control_boat": "command { command_id: 17 control_boat { boat_id: 1 throttle_ratio: 0.5 rudder_ratio: -1 } }",
    "remove_boat": "command { command_id: 18 remove_boat { boat_id: 1 } }",
    "step": "command { command_id: 19 step { tick_count: 10 } }",
    "change_scene": 'command { command_id: 20 change_scene { name: "harbor" } }',
    "change_scene_path": 'command { command_id: 21 change_scene { name: "../harbor" } }',
    "no_action": "command { command_id: 22 }",
    "spawn_floater": "command { command_id: 23 spawn_floater { floater { kind: FLOATER_KIND_DUCK x_m: 1 y_m: 3 velocity_z_mps: -4 } } }",
    "spawn_floater_in_rock": "command { command_id: 24 spawn_floater { floater { x_m: 4 } } }",
    "hold_floater": "command { command_id: 25 hold_floater { floater_id: 1 x_m: 2 z_m: -1 lift_m: 0.5 turn_radps: 1 } }",
    "set_lesson": "command { command_id: 27 set_lesson { lesson { frozen: true tools: TOOL_BOAT tools: TOOL_RAIN force_ratio: 0.3 teams: true } } }",
    "set_lesson_nan": "command { command_id: 28 set_lesson { lesson { tools: TOOL_BOAT tools: TOOL_BOAT force_ratio: nan } } }",
    "mute_person": "command { command_id: 29 mute_person { person_id: 4294967295 muted: true } }",
    "set_team": "command { command_id: 30 set_team { person_id: 1 team: TEAM_BLUE } }",
    "start_race": "command { command_id: 31 start_game { kind: GAME_KIND_RACE laps_count: 0 countdown_s: 5 } }",
    "start_ball": "command { command_id: 32 start_game { kind: GAME_KIND_BALL goals_count: 2 } }",
    "end_game": "command { command_id: 33 end_game { } }",
    "remove_floaters": "command { command_id: 26 remove_floater { all: true } }",
    "place_gauge": "command { command_id: 34 place_gauge { x_m: 3.5 z_m: -2 } }",
    "place_gauge_nan": "command { command_id: 35 place_gauge { x_m: nan z_m: 600 } }",
    "remove_gauge": "command { command_id: 36 remove_gauge { gauge_id: 4294967295 } }",
    "query": "command { command_id: 37 query { query_id: 1 x_m: 1.5 x_m: -2 z_m: 0 z_m: 900 } }",
    "query_stream": "command { command_id: 38 query { x_m: 1 x_m: 2 z_m: 3 z_m: 4 velocity_x_mps: 0.5 velocity_z_mps: 1 velocity_z_mps: -1 interval_ticks: 1 } }",
    "query_faulty": "command { command_id: 39 query { x_m: nan x_m: inf z_m: 1 velocity_x_mps: 1 velocity_x_mps: 2 velocity_x_mps: 3 interval_ticks: 3601 } }",
}

# Commands and requests of the REST interface.
JSON_MESSAGES = {
    "json_boat": '{"command_id":"7","spawn_boat":{"boat":{"x_m":1,"heading_deg":90}}}',
    "json_query": '{"x_m":[1,2.5],"z_m":[-1,1e3]}',
    "json_room": '{"name":"a","scene":"pond","fidelity":"FIDELITY_DRAFT"}',
    "json_splash": '{"splash":{"x_m":1,"depth_m":0.4}}',
}

FRAME_ROWS = {
    "surface_row": ["surface_packed_0.bin", "surface_packed_1.bin", "surface_packed_2.bin"],
    "surface_gap": ["surface_packed_0.bin", "surface_packed_2.bin"],
    "foam_row": ["foam_packed_0.bin", "foam_packed_1.bin"],
    "floater_row": ["floaters_packed_0.bin", "floaters_packed_1.bin", "floaters_packed_2.bin"],
    "floater_gap": ["floaters_packed_0.bin", "floaters_packed_2.bin", "floaters_2.bin"],
    "mixed": ["surface_packed_0.bin", "foam_packed_0.bin", "particles_packed.bin", "surface_packed_1.bin", "foam_packed_1.bin"],
    "broken_then_whole": ["surface_packed_0.bin", "bad_surface_packed_cut.bin", "surface_packed_1.bin", "surface_packed_0.bin"],
}
MARK = b"\xff\xff===="

UPGRADE = (
    "GET {target} HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
    "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: c3BpbmRyaWZ0IHRlc3RzIQ==\r\n{more}\r\n"
)
REQUESTS = {
    "page": "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n",
    "head": "HEAD /index.html HTTP/1.1\r\nHost: localhost\r\n\r\n",
    "asset": "GET /assets/a.js?v=1 HTTP/1.1\r\nHost: localhost\r\nIf-None-Match: \"1-2\", W/\"3\"\r\n\r\n",
    "any_etag": "GET /assets/a.js HTTP/1.1\r\nHost: localhost\r\nIf-None-Match: *\r\n\r\n",
    "hidden": "GET /.hidden HTTP/1.1\r\nHost: localhost\r\n\r\n",
    "link": "GET /out.txt HTTP/1.1\r\nHost: localhost\r\n\r\n",
    "above": "GET /assets/%2e%2e/../%2e./secret.txt HTTP/1.1\r\nHost: localhost\r\n\r\n",
    "escapes": "GET /%41%00%zz%5c HTTP/1.1\r\nHost: localhost\r\n\r\n",
    "health_two": "GET /healthz HTTP/1.1\r\nHost: a\r\n\r\nGET /readyz HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n",
    "old": "GET /metrics HTTP/1.0\r\n\r\n",
    "old_kept": "GET /healthz HTTP/1.0\r\nConnection: keep-alive\r\n\r\nGET / HTTP/1.0\r\n\r\n",
    "post": "POST /api/v1/rooms HTTP/1.1\r\nHost: a\r\nContent-Length: 4\r\n\r\nbody",
    "post_big": "POST /api/v1/rooms HTTP/1.1\r\nHost: a\r\nContent-Length: 4000000000\r\n\r\nbody",
    "chunked": "POST /api/v1/rooms HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n4;x=y\r\nbody\r\n0\r\nA: b\r\n\r\n",
    "chunked_and_length": "POST /api/x HTTP/1.1\r\nHost: a\r\nContent-Length: 4\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
    "folded": "GET / HTTP/1.1\r\nHost: a\r\nX-Long: a\r\n  b\r\n\r\n",
    "expect": "PUT /api/x HTTP/1.1\r\nHost: a\r\nExpect: 100-continue\r\nContent-Length: 1\r\n\r\nx",
    "trace": "TRACE /api/x HTTP/1.1\r\nHost: a\r\n\r\n",
    "connect": "CONNECT localhost:1 HTTP/1.1\r\nHost: a\r\n\r\n",
    "star": "OPTIONS * HTTP/1.1\r\nHost: a\r\n\r\n",
    "absolute": "GET http://localhost/ HTTP/1.1\r\nHost: a\r\n\r\n",
    "plain_ws": "GET /ws HTTP/1.1\r\nHost: a\r\n\r\n",
    "upgrade": UPGRADE.format(target="/ws", more=""),
    "upgrade_room": UPGRADE.format(target="/ws/pool", more="Sec-WebSocket-Protocol: chat, spindrift.v1\r\n"),
    "upgrade_other": UPGRADE.format(target="/ws/pool", more="Sec-WebSocket-Protocol: spindrift.v2\r\n"),
    "upgrade_nowhere": UPGRADE.format(target="/ws/%2e%2e%2fpool", more=""),
    "upgrade_early_frame": UPGRADE.format(target="/ws", more="") + "\u0082\u0080\0\0\0\0",
    "chunked_empty": "POST /api/x HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
    "not_http": "hello water\r\n\r\n",
    "endless": "GET / HTTP/1.1\r\nHost: " + "a" * 300,
    "other_coding": "POST /api/x HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: xchunked\r\nContent-Length: 5\r\n\r\n0\r\n\r\n",
}

FORWARDED = {
    "one": "203.0.113.9",
    "chain": "198.51.100.1, 203.0.113.9:4711,10.0.0.2\n10.0.0.3",
    "ipv6": "[2001:db8::9]:4711, fd00::1 , ::1",
    "mapped": "::ffff:203.0.113.9, ::ffff:10.0.0.2",
    "proxies": "10.0.0.4,10.0.0.3",
    "unknown": "unknown, 10.0.0.1",
    "empty_entries": ",, ,\n\n,",
    "zone": "fe80::1%eth0",
    "network": "10.0.0.0/8",
    "network_v6": "2001:db8::/33",
}

SCENES = {
    "wave": "wave {}\n",
    "particles": "particles { count: 100 boundary_x: BOUNDARY_WALL }\n",
    "every_part": "name: 'full' gravity_mps2: 9.81\nwave { resolution_count: 64 depth_m: 1.5 stencil: STENCIL_NINE_POINT }\n"
    "particles { count: 100 boundary_x: BOUNDARY_WALL }\ncoupling { lattice_count: 3 }\nfoam { lifetime_s: 1e0 }\n"
    "events { at_s: 1 effect { splash { x_m: -2 depth_m: 0.4 } } }\n"
    "obstacles { rock { x_m: 5 } }\nboats { boats { z_m: -3 } }\nfloaters { floaters { x_m: 2 size_m: 0.5 } }\nstorm { level_ratio: 0.5 }\n",
    "fine": "fidelity: FIDELITY_FINE wave { resolution_count: 64 }\n",
    "wrong": "wave { depth_m: -1 colour: 'blue' }\nparticles { count: 1e9 }\nnonsense: 1\nname: 'a b'\n",
    "wrong_types": "wave: 3\ngravity_mps2: 'nine'\nevents { at_s: nan }\nwave { stencil: STENCIL_TEN }\n",
    "braces": "wave { { { [ < > } }\n",
    "comment": "# nothing but words\n",
    "repeated": "wave {} wave {} gravity_mps2: 1 gravity_mps2: 2\n",
    "unknown": "[type.googleapis.com/spindrift.v1.Scene] { wave {} }\n\tx: \"\\x00\\n\"\n",
}


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x82F63B78 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF


def state_start(magic, generation, number, room, rest=b""):
    """Returns the header of a snapshot or log: `rest` is what a snapshot has before the room's name."""
    covered = struct.pack("<IQQ", len(room), generation, number) + rest + room
    return magic + struct.pack("<I", crc32c(covered)) + covered


def snapshot(payload, generation=1, magic=b"spinsnp2", room=b"pool", number=1, length=None):
    rest = struct.pack("<QI", len(payload) if length is None else length, crc32c(payload))
    return state_start(magic, generation, number, room, rest) + payload


def state_record(payload, number, length=None):
    covered = struct.pack("<IQI", len(payload) if length is None else length, number, crc32c(payload))
    return struct.pack("<I", crc32c(covered)) + covered + payload


def log(*records, generation=1, magic=b"spinlog2", room=b"pool", first=1):
    return state_start(magic, generation, first, room) + b"".join(state_record(r, first + k) for k, r in enumerate(records))


def old_snapshot(payload):
    return b"spinsnp1" + struct.pack("<QQI", 1, len(payload), crc32c(payload)) + payload


def old_log(*records):
    return b"spinlog1" + struct.pack("<Q", 1) + b"".join(struct.pack("<II", len(r), crc32c(r)) + r for r in records)


def state_files():
    """Returns the files of a room's state, each after the byte that says what the target tries with it."""
    plain, repaired, other_name = b"\0", b"\1", b"\2"
    return {
        "snapshot": plain + snapshot(b"state of the water"),
        "snapshot_empty": plain + snapshot(b"", generation=7),
        "snapshot_cut": plain + snapshot(b"state of the water")[:-3],
        "snapshot_changed": repaired + snapshot(b"state of the water")[:-1] + b"!",
        "snapshot_newer": plain + snapshot(b"state", magic=b"spinsnp3"),
        "snapshot_huge": plain + snapshot(b"x", length=2**63),
        "snapshot_old": plain + old_snapshot(b"state of the water"),
        "snapshot_other_room": other_name + snapshot(b"state of the water", room=b"quay"),
        "log": plain + log(b"a", b"splash", b"wave" * 10),
        "log_empty": plain + log(),
        "log_cut": plain + log(b"a", b"splash")[:-2],
        "log_changed": repaired + log(b"a", b"splash")[:-1] + b"!",
        "log_other_name": other_name + log(b"a", generation=2),
        "log_other_room": other_name + log(b"a", room=b"quay"),
        "log_old": plain + old_log(b"a", b"splash"),
        "log_older": plain + log(b"a", magic=b"spinlog0"),
        "log_huge": plain + log(b"a") + state_record(b"x", 2, length=2**32 - 1),
        "log_zeros": repaired + log(b"a") + bytes(40),
        "log_doubled": plain + log(b"a", first=9) + state_record(b"a", 9),
        "log_gap": plain + log(b"a", first=9) + state_record(b"c", 12),
    }


def cluster():
    """Returns frames and parts as they come over the bus, each after the byte that says what the target tries with it."""
    frame, parts = b"\0", b"\1"

    def framed(keyframe, delta, run=7, sequence=9, mark=0x53504631):
        return struct.pack("<IQQIII", mark, run, sequence, 2, len(keyframe), len(delta)) + keyframe + delta

    def rows(*pieces):
        out = b""
        for message, part, part_count, content in pieces:
            piece = struct.pack("<QII", message, part, part_count) + content
            out += struct.pack("<H", len(piece)) + piece
        return out

    return {
        "frame_both": frame + framed(b"keyframe", b"delta"),
        "frame_delta": frame + framed(b"", b"delta"),
        "frame_empty": frame + framed(b"", b""),
        "frame_cut": frame + framed(b"keyframe", b"")[:-1],
        "frame_other_mark": frame + framed(b"keyframe", b"", mark=0x53504632),
        "frame_sizes_wrap": frame + struct.pack("<IQQIII", 0x53504631, 1, 1, 0, 2**32 - 1, 4) + b"key",
        "parts_one": parts + rows((1, 0, 1, b"wave")),
        "parts_in_order": parts + rows((1, 0, 3, b"a"), (1, 1, 3, b"bc"), (1, 2, 3, b"d")),
        "parts_lost": parts + rows((1, 0, 3, b"a"), (1, 2, 3, b"d"), (2, 0, 2, b"e"), (2, 1, 2, b"f")),
        "parts_interleaved": parts + rows((1, 0, 2, b"a"), (2, 0, 2, b"b"), (1, 1, 2, b"c"), (2, 1, 2, b"d")),
        "parts_too_many_open": parts + rows(*((message, 0, 2, b"") for message in range(40))),
        "parts_other_count": parts + rows((1, 0, 2, b"a"), (1, 1, 3, b"b"), (1, 0, 65, b""), (1, 0, 0, b"")),
        "parts_most": parts + rows(*((1, part, 50, b"") for part in range(50))),
        "parts_short": parts + struct.pack("<H", 15) + bytes(15),
    }


def base64url(data):
    return base64.urlsafe_b64encode(data).rstrip(b"=")


def access():
    """Returns tokens and files of keys, each after the byte that says what the target tries with it."""
    token, signed, key_set, pem, file = b"\0", b"\1", b"\2", b"\3", b"\4"
    secret = b"a-secret-of-at-least-32-characters"
    claims = '{"role":"player","exp":1800003600,"sub":"ada","name":"Ada","room":["main","lab"],"nbf":1,"iat":1.5}'

    def jwt(header, text):
        content = base64url(header.encode()) + b"." + base64url(text.encode())
        return content + b"." + base64url(hmac.new(secret, content, hashlib.sha256).digest())

    modulus = base64url(bytes([255] * 255 + [1])).decode()
    keys = [
        {"kty": "oct", "k": base64url(secret).decode(), "kid": "a", "alg": "HS256"},
        {"kty": "RSA", "n": modulus, "e": "AQAB", "use": "sig"},
        {"kty": "OKP", "crv": "Ed25519", "x": "11qYAYKxCrfVS_7TyWQHOg7hcvPapiMlrwIaaPcHURo"},
        {"kty": "EC", "crv": "P-256", "x": "AA", "y": "AA"},
    ]
    ed25519 = base64.b64encode(bytes.fromhex("302a300506032b6570032100") + bytes(range(32))).decode()
    return {
        "jwt": token + jwt('{"alg":"HS256"}', claims),
        "jwt_expired": token + jwt('{"alg":"HS256"}', '{"role":"player","exp":1}'),
        "jwt_none": token + base64url(b'{"alg":"none"}') + b"." + base64url(claims.encode()) + b".",
        "jwt_other": token + jwt('{"alg":"RS256","kid":"b"}', claims),
        "signed": signed + b'{"alg":"HS256","kid":"a"}\n' + claims.encode(),
        "signed_crit": signed + b'{"alg":"HS256","crit":["b64"]}\n' + claims.encode(),
        "signed_wrong": signed + b'{"alg":"HS256"}\n{"role":5,"exp":"x","room":[{}],"sub":[[[[]]]]}',
        "signed_big": signed + b'{"alg":"HS256"}\n{"role":"operator","exp":1e300}',
        "keys": key_set + json.dumps({"keys": keys}).encode(),
        "keys_private": key_set + json.dumps({"keys": [keys[2] | {"d": "AA"}]}).encode(),
        "pem": pem + f"-----BEGIN PUBLIC KEY-----\n{ed25519}\n-----END PUBLIC KEY-----\n".encode(),
        "tokens": file + b"# class\noperator aaaaaaaaaaaaaaaa room=a,b sub=ada until=2030-01-31T12:00:00Z\nplayer bbbbbbbbbbbbbbbb\n",
        "tokens_wrong": file + b"king aaaaaaaaaaaaaaaa\n",
    }


def der(tag, *parts):
    """An element of DER (X.690) whose content is the parts."""
    content = b"".join(parts)
    length = bytes([len(content)]) if len(content) < 128 else b"\x82" + struct.pack(">H", len(content))
    return bytes([tag]) + length + content


# The base point of P-256, which is the public key of the private key 1, so that neither is anybody's.
P256_BASE = bytes.fromhex(
    "046b17d1f2e12c4247f8bce6e563a440f277037d812deb33a0f4a13945d898c2964fe342e2fe1a7f9b8ee7eb4a7c0f9e162bce33576b315ececbb6406837bf51f5"
)


def certificate(ends=b"300101000000Z", name=b"localhost", names=b"\x82\x09localhost"):
    """A certificate for the private key 1, valid from 2020 to 2030, with an invalid signature: nobody checks it."""
    ecdsa_sha256 = der(0x30, bytes.fromhex("06082a8648ce3d040302"))
    subject = der(0x30, der(0x31, der(0x30, bytes.fromhex("0603550403"), der(0x0C, name))))
    times = der(0x30, der(0x17, b"200101000000Z"), der(0x17, ends))
    curve = der(0x30, bytes.fromhex("06072a8648ce3d020106082a8648ce3d030107"))
    public_key = der(0x30, curve, der(0x03, b"\0", P256_BASE))
    extensions = der(0xA3, der(0x30, der(0x30, bytes.fromhex("0603551d11"), der(0x04, der(0x30, names)))))
    content = der(0x30, der(0xA0, der(0x02, b"\2")), der(0x02, b"\1"), ecdsa_sha256, subject, times, subject, public_key, extensions)
    return der(0x30, content, ecdsa_sha256, der(0x03, b"\0", der(0x30, der(0x02, b"\1"), der(0x02, b"\1"))))


def private_key(number=1, public=P256_BASE):
    """PKCS #8 (RFC 5208) of a key of P-256."""
    algorithm = der(0x30, bytes.fromhex("06072a8648ce3d020106082a8648ce3d030107"))
    key = der(0x30, der(0x02, b"\1"), der(0x04, number.to_bytes(32, "big")), der(0xA1, der(0x03, b"\0", public)))
    return der(0x30, der(0x02, b"\0"), algorithm, der(0x04, key))


def pem(name, content):
    text = base64.b64encode(content).decode()
    lines = [text[at : at + 64] for at in range(0, len(text), 64)]
    return "\n".join([f"-----BEGIN {name}-----", *lines, f"-----END {name}-----", ""]).encode()


def client_hello(versions=(0x0304, 0x0303), share=b"\x09" + bytes(31), protocol=b"http/1.1", ciphers=(0x1301, 0xC02B, 0xC02F)):
    """The first record of a client: RFC 8446 section 4.1.2. `share`: its key of X25519; empty: none."""

    def sized(length_bytes, content):
        return len(content).to_bytes(length_bytes, "big") + content

    def extension(number, content):
        return struct.pack(">H", number) + sized(2, content)

    words = lambda *values: b"".join(struct.pack(">H", value) for value in values)  # noqa: E731
    extensions = extension(0, sized(2, b"\0" + sized(2, b"localhost")))
    extensions += extension(10, sized(2, words(0x001D, 0x0017)))
    extensions += extension(11, sized(1, b"\0"))
    extensions += extension(13, sized(2, words(0x0403, 0x0804, 0x0401)))
    extensions += extension(16, sized(2, sized(1, protocol)))
    extensions += extension(23, b"") + extension(35, b"")
    if 0x0304 in versions:
        extensions += extension(43, sized(1, words(*versions)))
        extensions += extension(45, sized(1, b"\1"))
        extensions += extension(51, sized(2, words(0x001D) + sized(2, share) if share else b""))
    body = words(0x0303) + bytes(range(32)) + sized(1, bytes(range(32))) + sized(2, words(*ciphers)) + sized(1, b"\0") + sized(2, extensions)
    return record(22, b"\1" + sized(3, body))


def record(kind, content, version=0x0301):
    return struct.pack(">BHH", kind, version, len(content)) + content


def tls():
    """Returns bytes of clients, and files of certificates and keys, each after the byte that says what the target tries."""
    plain, tampered, files, as_der = b"\0", b"\1", b"\2", b"\3"
    all_later, all_early, cut = b"\0", b"\xff", b"\x07"
    change_cipher = record(20, b"\1", 0x0303)
    key_exchange = record(22, b"\x10\0\0\x42\x41" + P256_BASE, 0x0303)
    finished = record(22, bytes(range(40)), 0x0303)
    old_hello = client_hello(versions=(0x0303,))

    def changed(place, change, kind, *pieces, buffer=4):
        rows = b"".join(bytes([len(piece)]) + piece for piece in pieces)
        return tampered + struct.pack("<HBBB", place, change, kind, buffer) + rows

    tls_1_2, other_protocol, vanishes, http = 1, 2, 4, 8
    good, key = certificate(), private_key()
    text, key_text = pem("CERTIFICATE", good), pem("PRIVATE KEY", key)
    parameters = pem("EC PARAMETERS", bytes.fromhex("06082a8648ce3d030107"))
    locked = b"-----BEGIN EC PRIVATE KEY-----\nProc-Type: 4,ENCRYPTED\nDEK-Info: AES-128-CBC,00112233445566778899AABBCCDDEEFF\n\n"
    locked += base64.b64encode(bytes(64)) + b"\n-----END EC PRIVATE KEY-----\n"

    def pair(one, other):
        return as_der + struct.pack("<H", len(one)) + one + other

    return {
        "hello": plain + all_later + client_hello(),
        "hello_early": plain + all_early + client_hello(),
        "hello_cut": plain + cut + client_hello()[:-9],
        "hello_no_share": plain + all_later + client_hello(share=b"") + change_cipher + client_hello(),
        "hello_other_protocol": plain + all_later + client_hello(protocol=b"h2"),
        "hello_no_cipher": plain + all_later + client_hello(ciphers=(0x0005,)),
        "hello_1_2": plain + cut + old_hello + key_exchange + change_cipher + finished,
        "hello_1_2_twice": plain + all_later + old_hello + old_hello,
        "hello_1_3_finished": plain + all_later + client_hello() + change_cipher + record(23, bytes(53), 0x0303),
        "hello_in_pieces": plain + all_later + b"".join(record(22, bytes([byte])) for byte in client_hello()[5:60]),
        "alert": plain + all_later + record(21, b"\2\x28"),
        "record_too_long": plain + all_later + b"\x16\3\1\xff\xff" + bytes(64),
        "record_empty": plain + all_later + record(22, b"") * 40,
        "http": plain + all_later + b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n",
        "version_2": plain + all_later + b"\x80\x2e\1\0\2\0\x15\0\0\0\x10" + bytes(40),
        "whole": changed(0xFFFF, 0, http, b"GET / HTTP/1.1\r\n\r\n", b"x" * 200),
        "whole_1_2": changed(0xFFFF, 0, http | tls_1_2, b"GET / HTTP/1.1\r\n\r\n", b"x" * 200, buffer=0),
        "whole_long": changed(0xFFFF, 0, http, bytes(range(250)), b"", bytes(range(5, 255)), buffer=255),
        "whole_vanishes": changed(0xFFFF, 0, vanishes, b"x"),
        "whole_other_protocol": changed(0xFFFF, 0, other_protocol, b"x"),
        "whole_new_keys": changed(0xFFFF, 0, 0, b"a", b"", b"b", b"", b"", b"c"),
        "whole_new_handshake": changed(0xFFFF, 0, tls_1_2, b"a", b"", b"b"),
        "changed_hello": changed(9, 1, 0, b"x"),
        "changed_finished": changed(560, 128, 0, b"x"),
        "changed_content": changed(700, 4, http, b"x" * 250, b"y" * 250),
        "changed_1_2": changed(300, 32, tls_1_2, b"x" * 250),
        "files": files + text + b"\0" + key_text,
        "files_chain": files + text + pem("CERTIFICATE", certificate(ends=b"210101000000Z", name=b"ca")) + b"\0" + parameters + key_text,
        "files_swapped": files + key_text + b"\0" + text,
        "files_passphrase": files + text + b"\0" + locked,
        "files_no_pem": files + b"hello\0hello",
        "files_empty": files,
        "files_cut": files + text[:-60] + b"\0" + key_text,
        "der": pair(good, key),
        "der_other_key": pair(good, private_key(number=2, public=b"\x04" + bytes(64))),
        "der_zero_key": pair(good, private_key(number=0)),
        "der_date": pair(certificate(ends=b"999999999999Z"), key),
        "der_names": pair(certificate(names=b"\x82\x82\xff\xff"), key),
    }


FOXGLOVE = {
    "subscribe": (b't{"op":"subscribe","subscriptions":[{"id":1,"channelId":1},{"id":2,"channelId":4}]}', "surface_16", "bodies_2",
                  b't{"op":"unsubscribe","subscriptionIds":[1]}'),
    "layers": (b't{"op":"subscribe","subscriptions":[{"id":1,"channelId":9},{"id":2,"channelId":3},{"id":3,"channelId":7}]}', "particles_5", "diagnostics_gauges"),
    "parameters": (b't{"op":"subscribeParameterUpdates","parameterNames":[]}', b't{"op":"getParameters","parameterNames":["wave.depth_m"],"id":"a"}',
                   b't{"op":"setParameters","id":"b","parameters":[{"name":"wave.depth_m","value":3.5},{"name":"x","value":true}]}', "ack"),
    "splash": (b'b\2\1\0\0\0\7\0\0\0\4\0\0\0json{"x_m":1.5,"radius_m":2}', "ack"),
    "reset": (b"b\2\2\0\0\0\7\0\0\0\4\0\0\0json", "reject"),
    "greeted_again": (b't{"op":"subscribe","subscriptions":[{"id":1,"channelId":2}]}', "greeting"),
    "garbage": (b"t{", b"t[]", b"b", b"b\1\0\0\0\0", b't{"op":"advertise","channels":[]}', b"b\2\1\0\0\0\1\0\0\0\xff\xff\xff\xff", b"s\0\0"),
}


def encoded(text):
    command = ["protoc", f"--proto_path={PROTO}", "--encode=spindrift.v1.ClientMessage", "spindrift/v1/wire.proto"]
    return subprocess.run(command, input=text.encode(), stdout=subprocess.PIPE, check=True).stdout


def write(target, seeds):
    folder = FOLDER / target
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.iterdir():
        old.unlink()
    for name, content in seeds.items():
        (folder / name).write_bytes(content)


def main():
    golden = ROOT / "tests" / "golden"
    messages = {name: encoded(text) for name, text in CLIENT_MESSAGES.items()}
    write("client_message", messages | {name: text.encode() for name, text in JSON_MESSAGES.items()})
    write("frame", {name: MARK.join((golden / file).read_bytes() for file in row) for name, row in FRAME_ROWS.items()})
    # Names are golden messages of the server.
    write("foxglove", {name: MARK.join(part if isinstance(part, bytes) else b"s" + (golden / f"{part}.bin").read_bytes() for part in row)
                       for name, row in FOXGLOVE.items()})
    # The first byte is the size of the pieces in which a request arrives.
    pieces = (b"\xff", b"\x00", b"\x03")
    write("http", {name: pieces[i % 3] + text.encode("latin-1") for i, (name, text) in enumerate(REQUESTS.items())})
    write("access", access())
    write("cluster", cluster())
    write("forwarded", {name: text.encode() for name, text in FORWARDED.items()})
    write("state_files", state_files())
    write("tls", tls())
    write("scene", {name: text.encode() for name, text in SCENES.items()})


if __name__ == "__main__":
    main()

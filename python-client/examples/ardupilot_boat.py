"""A boat for ArduPilot: the physics behind its JSON interface, so that Rover's own code steers a boat in waves.

    python ardupilot_boat.py http://localhost:8080 --port 9002
    sim_vehicle.py -v Rover -f motorboat --model JSON:127.0.0.1

Every datagram of ArduPilot (magic, frame rate, frame count, 16 or 32 servo pulses) sets rudder (channel 1) and throttle (channel 3) and is
answered with the state of the boat as JSON (github.com/ArduPilot/ardupilot, libraries/SITL/examples/JSON/readme.md). North is +x, east
is +z, down is -y. The room has to have a place for a boat, and no
periodic sides: a boat that enters at the other one would jump.
"""
import argparse
import asyncio
import json
import math
import struct

import numpy as np

import spindrift
from spindrift import aio

GRAVITY_MPS2 = 9.81
CHANNELS = {18458: 16, 29569: 32}
"""Number of pulses by the magic number of the datagram."""


def pulses_of(datagram):
    """frame_count and the pulses [us]; None if ArduPilot did not send it."""
    count = CHANNELS.get(struct.unpack_from("<H", datagram)[0] if len(datagram) >= 8 else 0)
    if count is None or len(datagram) != 8 + 2 * count:
        return None
    _, _, frame_count, *pulses = struct.unpack(f"<HHI{count}H", datagram)
    return frame_count, pulses


def ratio_of(pulse_us):
    """-1 to 1; a channel without a signal (0) is in the middle."""
    return float(np.clip((pulse_us - 1500) / 500, -1, 1)) if pulse_us else 0.0


def body_axes(roll, pitch, yaw):
    """Rows: forward, right and down of the body in north, east, down."""
    cr, sr, cp, sp, cy, sy = (f(angle) for angle in (roll, pitch, yaw) for f in (math.cos, math.sin))
    return np.array([[cp * cy, cp * sy, -sp], [sr * sp * cy - cr * sy, sr * sp * sy + cr * cy, sr * cp], [cr * sp * cy + sr * sy, cr * sp * sy - sr * cy, cr * cp]])


class Motion:
    """Velocities and accelerations from the poses of two frames."""

    def __init__(self):
        self._before = None

    def state(self, frame, index):
        """What ArduPilot reads, or None for the same moment again."""
        x, y, z = frame.positions_m[index]
        position = np.array([x, z, -y])
        attitude = np.array([frame.roll_rad[index], frame.pitch_rad[index], frame.heading_rad[index]])
        before, axes = self._before, body_axes(*attitude)
        if before is not None and frame.time_s <= before["time_s"]:
            return None
        velocity, rates, acceleration = np.zeros(3), np.zeros(3), np.zeros(3)
        if before is not None:
            step_s = frame.time_s - before["time_s"]
            velocity = (position - before["position"]) / step_s
            acceleration = (velocity - before["velocity"]) / step_s
            roll, pitch, yaw = ((new - old + math.pi) % (2 * math.pi) - math.pi for new, old in zip(attitude, before["attitude"]))
            sr, cr, sp, cp = math.sin(attitude[0]), math.cos(attitude[0]), math.sin(attitude[1]), math.cos(attitude[1])
            rates = np.array([roll - yaw * sp, pitch * cr + yaw * sr * cp, yaw * cr * cp - pitch * sr]) / step_s
        self._before = {"time_s": frame.time_s, "position": position, "velocity": velocity, "attitude": attitude}
        # An accelerometer measures what the water does, not gravity: at rest -g along down.
        felt = axes @ (acceleration - np.array([0, 0, GRAVITY_MPS2]))
        return {"timestamp": frame.time_s, "imu": {"gyro": rates.tolist(), "accel_body": felt.tolist()}, "position": position.tolist(),
                "attitude": attitude.tolist(), "velocity": velocity.tolist()}


class Inlet(asyncio.DatagramProtocol):
    """Keeps the newest datagram; older ones that nobody took are replaced."""

    def __init__(self):
        self.newest = asyncio.Queue(maxsize=1)

    def datagram_received(self, data, addr):
        if self.newest.full():
            self.newest.get_nowait()
        self.newest.put_nowait((data, addr))


async def run(url, port, frame_limit):
    transport, inlet = await asyncio.get_running_loop().create_datagram_endpoint(Inlet, local_addr=("127.0.0.1", port))
    try:
        async with aio.connect(url, name="ArduPilot") as water:
            boat_id = (await water.spawn_boat(x_m=0, z_m=0, heading_deg=0)).boat_id
            print(f"boat {boat_id} waits for ArduPilot at port {transport.get_extra_info('sockname')[1]}", flush=True)
            motion, sent, answered = Motion(), None, 0
            while answered != frame_limit:
                datagram, sender = await inlet.newest.get()
                if (read := pulses_of(datagram)) is None:
                    print(f"{sender[0]}: {len(datagram)} bytes that are not of ArduPilot", flush=True)
                    continue
                control = {"rudder_ratio": ratio_of(read[1][0]), "throttle_ratio": ratio_of(read[1][2])}
                if control != sent:
                    try:
                        await water.control_boat(boat_id=boat_id, **control)
                        sent = control
                    except spindrift.Rejected as error:
                        print(f"not steered: {error}", flush=True)
                state = None
                while state is None:
                    frame = await water.bodies()
                    index = frame.index_of(boat_id)
                    state = None if index is None else motion.state(frame, index)
                transport.sendto(f"\n{json.dumps(state)}\n".encode(), sender)
                answered += 1
            await water.remove_boat(boat_id=boat_id)
    finally:
        transport.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("url", nargs="?", default="http://localhost:8080")
    parser.add_argument("--port", type=int, default=9002, help="of UDP; 0: any free one")
    parser.add_argument("--frames", type=int, default=-1, help="end after so many answers; -1: never")
    arguments = parser.parse_args()
    asyncio.run(run(arguments.url, arguments.port, arguments.frames))


if __name__ == "__main__":
    main()

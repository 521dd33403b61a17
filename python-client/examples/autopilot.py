"""A boat in a storm that an autopilot brings onto its course and holds there, and one whose rudder stays amidships.

    python autopilot.py --course 20 --seconds 8

It starts a server of its own with storm.textproto; --url: another one, whose scene has room for boats. Prints how far the headings are
from the course.
"""
import argparse
import math
import pathlib

import numpy as np

import spindrift


def off_course(heading_rad, course_rad):
    """The short way round. [rad]"""
    return math.remainder(heading_rad - course_rad, 2 * math.pi)


def rudder_for(error_rad, rate_radps, gain=2.0, damping_s=0.6):
    """Proportional and derivative: positive turns from +x toward +z."""
    return float(np.clip(-gain * (error_rad + damping_s * rate_radps), -1.0, 1.0))


def drive(water, boat_id, course_rad, seconds, steers):
    """Root mean square of the error of the heading in the second half of the time. [rad]"""
    errors, before, begun_s = [], None, None
    for frame in water.frames("bodies"):
        index = frame.index_of(boat_id)
        if index is None:
            continue
        begun_s = frame.time_s if begun_s is None else begun_s
        error = off_course(frame.heading_rad[index], course_rad)
        if steers and (before is None or frame.time_s - before[0] >= 0.1):
            rate = 0.0 if before is None else off_course(error, before[1]) / (frame.time_s - before[0])
            water.control_boat(boat_id=boat_id, throttle_ratio=0.5, rudder_ratio=rudder_for(error, rate))
            before = (frame.time_s, error)
        if frame.time_s - begun_s > 0.5 * seconds:
            errors.append(error)
        if frame.time_s - begun_s >= seconds:
            return float(np.sqrt(np.mean(np.square(errors))))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--url", default="", help="of a server that runs already")
    parser.add_argument("--course", type=float, default=20.0, help="degrees from +x toward +z")
    parser.add_argument("--seconds", type=float, default=8.0, help="of simulated time")
    parser.add_argument("--after", type=float, default=15.0, help="seconds in which the storm's waves come in")
    arguments = parser.parse_args()
    course_rad = math.radians(arguments.course)

    scene = str(pathlib.Path(__file__).with_name("storm.textproto"))
    with spindrift.connect(arguments.url, name="autopilot") if arguments.url else spindrift.serve(scene, name="autopilot") as water:
        while water.next("diagnostics").time_s < arguments.after:
            pass
        for steers in (False, True):
            start = {"x_m": -10 * math.cos(course_rad), "z_m": -10 * math.sin(course_rad), "heading_deg": arguments.course + 30}
            boat_id = water.spawn_boat(**start).boat_id
            water.control_boat(boat_id=boat_id, throttle_ratio=0.5)
            error_deg = math.degrees(drive(water, boat_id, course_rad, arguments.seconds, steers))
            water.remove_boat(boat_id=boat_id)
            print(f"{'autopilot' if steers else 'rudder amidships':17} {error_deg:5.1f} degrees off course (root mean square)", flush=True)


if __name__ == "__main__":
    main()

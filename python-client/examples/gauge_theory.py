"""A gauge of the flume against linear theory: how fast water moves under waves, and how fast they travel to the next gauge.

    python gauge_theory.py --seconds 30

It starts a server of its own. Airy: omega^2 = g k tanh(k d); the flow under a wave of height eta, as a mean over the depth, is c eta / d
with c = omega / k.
"""
import argparse
import math

import numpy as np

import spindrift

GRAVITY_MPS2 = 9.81


def wave_number(period_s, depth_m):
    """k of Airy's dispersion relation by Newton's method. [rad/m]"""
    omega2 = (2 * math.pi / period_s) ** 2
    k = omega2 / GRAVITY_MPS2 / math.sqrt(math.tanh(omega2 * depth_m / GRAVITY_MPS2))
    for _ in range(20):
        t = math.tanh(k * depth_m)
        k -= (GRAVITY_MPS2 * k * t - omega2) / (GRAVITY_MPS2 * (t + k * depth_m * (1 - t * t)))
    return k


def component(time_s, values, period_s):
    """Complex amplitude of the part with a period, over whole periods."""
    whole = time_s > time_s[-1] - period_s * math.floor((time_s[-1] - time_s[0]) / period_s)
    return 2 * np.mean(values[whole] * np.exp(-2j * math.pi * time_s[whole] / period_s))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=20.0, help="of simulated time before and while gauges are read")
    arguments = parser.parse_args()
    with spindrift.serve("flume") as water:
        period_s, depth_m = water.scene.wave_makers[0].regular.period_s, water.scene.wave.depth_m
        water.set_paused(paused=True)
        water.advance(round(60 * arguments.seconds))
        gauges = {name: water.gauge(name) for name in ("maker", "toe")}
    k = wave_number(period_s, depth_m)
    print(f"theory: wave length {2 * math.pi / k:.3f} m, speed {2 * math.pi / period_s / k:.3f} m/s")
    for name, gauge in gauges.items():
        recent = gauge.time_s > arguments.seconds - 4 * period_s
        eta, u = (component(gauge.time_s[recent], values[recent], period_s) for values in (gauge.elevation_m, gauge.velocity_x_mps))
        print(f"{name:6} elevation {abs(eta):.4f} m, flow {abs(u):.4f} m/s; speed of the waves from them {abs(u / eta) * depth_m:.3f} m/s")
        gauges[name] = (gauge, eta)
    (near, near_eta), (far, far_eta) = gauges.values()
    lag = -np.angle(far_eta / near_eta)
    expected = k * (far.x_m - near.x_m)
    lag += 2 * math.pi * round((expected - lag) / (2 * math.pi))
    print(f"wave length from one gauge to the other {2 * math.pi * (far.x_m - near.x_m) / lag:.3f} m")


if __name__ == "__main__":
    main()

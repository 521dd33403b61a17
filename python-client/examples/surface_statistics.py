"""Statistics of the surface over some seconds: significant height, steepness, highest crest and lowest trough.

    python surface_statistics.py http://localhost:8080 --seconds 20
"""
import argparse

import numpy as np

import spindrift


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("url", nargs="?", default="http://localhost:8080")
    parser.add_argument("--seconds", type=float, default=10.0, help="of simulated time")
    arguments = parser.parse_args()

    with spindrift.connect(arguments.url) as water:
        first = water.surface()
        heights_m, slopes = [], []
        for frame in water.frames("surface"):
            heights_m.append(frame.heights_m)
            slopes.append(np.gradient(frame.heights_m, frame.z_m, frame.x_m))
            if frame.time_s - first.time_s >= arguments.seconds:
                break
        lost = water.dropped["surface"]
    heights_m = np.stack(heights_m)
    moving_m = heights_m - heights_m.mean(axis=0)  # without dry ground and what stands still
    print(f"frames             {len(heights_m)} of {heights_m.shape[2]} x {heights_m.shape[1]} samples, {lost} dropped")
    print(f"significant height {4 * moving_m.std():.3f} m")
    print(f"mean slope         {np.sqrt(np.mean(np.square(slopes))):.4f}")
    print(f"highest, lowest    {heights_m.max():.3f} m, {heights_m.min():.3f} m")


if __name__ == "__main__":
    main()

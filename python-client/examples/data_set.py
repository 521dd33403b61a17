"""A data set for learning: many seeded runs of splashes, the surface before and after, in one .npz file.

    python data_set.py --runs 1000 --output water.npz

It starts a server of its own. The arrays: `before` and `after`, float16 [runs, count_z, count_x], heights in metres; `splashes`,
float32 [runs, splashes, 3], x, z and depth in metres; `seeds`; `x_m`; `z_m`. The same seeds give the same file on the same machine.
"""
import argparse

import numpy as np

import spindrift


def splashes_of(seed, count):
    """x, z and depth of some splashes. [m]"""
    random = np.random.default_rng(seed)
    return np.column_stack([random.uniform(-5, 5, count), random.uniform(-5, 5, count), random.uniform(0.1, 0.6, count)]).round(3)


def run(water, splashes, before_ticks, ticks):
    """Surfaces `before_ticks` after the splashes, and `ticks` later."""
    water.reset()
    for x_m, z_m, depth_m in splashes:
        water.splash(x_m=x_m, z_m=z_m, depth_m=depth_m, radius_m=0.8)
    before = water.advance(before_ticks)
    return before, water.advance(ticks)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=1000)
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--splashes", type=int, default=3)
    parser.add_argument("--ticks", type=int, default=60, help="between both surfaces, 60 per second of simulated time")
    parser.add_argument("--scene", default="wave_only")
    parser.add_argument("--output", default="water.npz")
    arguments = parser.parse_args()

    seeds = np.arange(arguments.first_seed, arguments.first_seed + arguments.runs)
    splashes = [splashes_of(seed, arguments.splashes) for seed in seeds]
    before, after = [], []
    with spindrift.serve(arguments.scene) as water:
        water.set_paused(paused=True)
        for each in splashes:
            first, last = run(water, each, 20, arguments.ticks)
            before.append(first.heights_m.astype(np.float16))
            after.append(last.heights_m.astype(np.float16))
    np.savez_compressed(arguments.output, before=np.stack(before), after=np.stack(after), splashes=np.array(splashes, np.float32), seeds=seeds,
                        x_m=last.x_m, z_m=last.z_m)
    print(f"{arguments.output}: {len(seeds)} runs of {last.samples.shape[1]} x {last.samples.shape[0]} samples")


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Renders views to measure the accuracy of poses: other instances of the scenes, noon against other lights. See README.md."""

import argparse
import os
import pathlib

import numpy as np

from localization import MAP_LIGHT, SIZE
from render import DEPTH, IMAGE, Task, render_all, run_quickly, start, write_text
from scenes import SCENES, STILLS, cameras, extrinsics, tum, walk

LIGHTS = ["night", "dusk", "winter"]
MAP_VIEWS, VIEWS = 5, 3  # pictures at noon along the walk, and of each other light beside it
# Largest offsets of the other lights' views from the walk: metres to the side and upward, degrees of yaw and pitch.
BESIDE = [0.4, 0.1, 5, 2]


def beside(scene, light, seed):
    """VIEWS x 5: poses near the walk, different for each light and seed."""
    random = np.random.default_rng([seed, LIGHTS.index(light)])
    poses = walk(SCENES[scene].path, 100)[np.sort(random.choice(100, VIEWS, replace=False))]
    poses[:, [0, 1, 3, 4]] += random.uniform(-1, 1, (VIEWS, 4)) * BESIDE
    return poses


def nearer(poses, metres, roll):
    """N x 6: poses moved along their optical axes, with a roll in degrees."""
    forward = np.array([extrinsics(pose)[2, :3] for pose in poses]) * [1, -1, 1]
    return np.column_stack([poses[:, :3] + metres * forward, poses[:, 3:], np.full(len(poses), roll)])


def plan(out, scenes, seeds, size, lights=tuple(LIGHTS), moved=(), depth=False, steps=None):
    for seed in seeds:
        for scene in scenes:
            mapped = walk(SCENES[scene].path, steps or MAP_VIEWS)
            views = {"map": (MAP_LIGHT, mapped)}
            views.update((light, (light, mapped if steps else beside(scene, light, seed))) for light in lights)
            if moved:
                views["nearer"] = MAP_LIGHT, np.concatenate([nearer(mapped, *each) for each in [(0, 0), *moved]])
            for name, (light, poses) in views.items():
                folder = out / f"{scene}_{seed}" / name
                names = [f"{k:04d}" for k in range(len(poses))]
                write_text(folder / "cameras.txt", cameras(scene, size))
                write_text(folder / "poses.txt", tum(names, poses))
                for k, pose in enumerate(poses):
                    yield Task(folder / "images" / f"{names[k]}.png", scene, IMAGE, light, pose, k, [], seed)
                    if depth:
                        yield Task(folder / "depth" / f"{names[k]}.png", scene, DEPTH, MAP_LIGHT, pose, k, [], seed)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path, help="output folder; existing pictures are kept")
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=STILLS, metavar="SCENE",
                        help=f"some of: {', '.join(SCENES)} ({' '.join(STILLS)})")
    parser.add_argument("--seed", nargs="+", type=int, default=[1, 2, 3], help="seeds of the instances; 0 is the scene of the other programs (1 2 3)")
    parser.add_argument("--lights", nargs="*", choices=LIGHTS, default=LIGHTS, metavar="LIGHT",
                        help=f"other than noon: some of {', '.join(LIGHTS)} (all)")
    parser.add_argument("--nearer", nargs=2, type=float, action="append", default=[], metavar=("METRES", "ROLL"),
                        help="adds a folder nearer: the views of map, and the same moved forward and rolled clockwise; may be repeated")
    parser.add_argument("--walk", type=int, metavar="STEPS", help="so many equal steps of the walk under every light, for tools/training")
    parser.add_argument("--depth", action="store_true", help="also renders the depth of each view, in depth/")
    parser.add_argument("--size", type=int, nargs=2, default=SIZE, metavar=("WIDTH", "HEIGHT"))
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="renderings at a time")
    options = parser.parse_args()
    size = tuple(options.size)
    render_all(list(plan(options.out, options.scenes, options.seed, size, options.lights, options.nearer, options.depth, options.walk)), size, options.jobs, run_quickly)


if __name__ == "__main__":
    start(main)

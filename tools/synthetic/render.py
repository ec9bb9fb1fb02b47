#!/usr/bin/python3
"""Renders the synthetic data: pictures under many lights, depth, labels, cameras. See README.md."""

import argparse
import concurrent.futures
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import zlib
from collections import namedtuple

import cv2
import numpy as np

from scenes import LIGHTS, NOISE, NOISE_BY_DAY, SCENES, STILLS, cameras, intrinsics, tum

HERE = pathlib.Path(__file__).resolve().parent
DEPTH_SCALE = 0.004  # metres a step, as in common.inc
IMAGE, DEPTH, LABELS = range(3)
# One ray a pixel and a blur are faster than antialiasing.
ONE_RAY, BLUR = ["+FN8", "-A"], 0.6
ATTEMPTS = 3  # POV-Ray 3.7 sometimes crashes, and renders the same scene at the next attempt
# One ray through the pixel's centre gives depth and label; pictures are antialiased without random numbers.
OUTPUT = {IMAGE: ["+FN8", "+A0.15", "+AM1", "+R2", "-J"], DEPTH: ["+FN16", "-A"], LABELS: ["+FN8", "-A"]}


def povray(scene, mode, light, pose, size, output=None, seed=0):
    """Renders height x width x 3, BGR, 8U for a picture; height x width, 16U for depth and 8U for labels."""
    width, height = size
    declared = dict(zip(("CamX", "CamY", "CamZ", "Yaw", "Pitch", "Roll"), [*pose, 0]), Mode=mode, Light=LIGHTS[light], Seed=seed,
                    Focal=intrinsics(scene, width, height)[0, 0])
    with tempfile.TemporaryDirectory() as folder:
        picture = os.path.join(folder, "frame.png")
        command = ["povray", f"+I{scene}.pov", f"+O{picture}", f"+W{width}", f"+H{height}",
                   "+WT1", "-D", "-GD", "-GR", "-GS", "-GW", *(output or OUTPUT[mode]),
                   f"File_Gamma={'srgb' if mode == IMAGE else '1.0'}",
                   *(f"Declare={name}={value:.9g}" for name, value in declared.items())]
        for _ in range(ATTEMPTS):  # in the scenes' folder, since povray accepts no path with a space
            done = subprocess.run(command, cwd=HERE, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            if done.returncode >= 0:
                break
        rendered = cv2.imread(picture, cv2.IMREAD_UNCHANGED) if done.returncode == 0 else None
    if rendered is None:
        why = done.stderr[done.stderr.find("[Parsing"):]
        raise RuntimeError(f"povray could not render {scene}, {light}:\n{why}")
    return rendered[..., :3] if mode == IMAGE else (rendered if rendered.ndim == 2 else rendered[..., 0])


def sensed(picture, scene, light, frame):
    """A picture with sensor noise, the same in every run."""
    random = np.random.default_rng([zlib.crc32(scene.encode()), LIGHTS[light], frame])
    noise = random.standard_normal(picture.shape) * NOISE.get(light, NOISE_BY_DAY)
    return np.clip(np.rint(picture + noise), 0, 255).astype(np.uint8)


def write(path, array):
    """Writes a picture under another name first, so that an interrupted run leaves no incomplete file and can resume."""
    path.parent.mkdir(parents=True, exist_ok=True)
    aside = path.with_name("." + path.name)
    if not cv2.imwrite(str(aside), array):
        raise RuntimeError(f"cannot write {path}")
    os.replace(aside, path)


def write_text(path, text):
    """Writes a text, and refuses to change an existing one, so that old and new pictures are not mixed."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if path.exists() and path.read_text() != text:
        raise RuntimeError(f"{path} is of another size or walk: choose another folder")
    path.write_text(text)


# A file to render, and its copies: all lights at a pose share depth and labels.
Task = namedtuple("Task", "target scene mode light pose frame copies seed", defaults=[0])


def run(task, size, quickly=False):
    if not task.target.exists():
        blurred = quickly and task.mode == IMAGE
        rendered = povray(task.scene, task.mode, task.light, task.pose, size, ONE_RAY if blurred else None, task.seed)
        if blurred:
            rendered = cv2.GaussianBlur(rendered, (0, 0), BLUR)
        if task.mode == IMAGE:
            rendered = sensed(rendered, task.scene, task.light, task.frame)
        write(task.target, rendered)
    for copy in task.copies:
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(task.target, copy)
    return task.target


def run_quickly(task, size):
    return run(task, size, quickly=True)


def plan(out, scenes, size):
    """Tasks of one pose of each scene under every light: a sequence 1.png..N.png with identities H_1_k."""
    for scene in scenes:
        folder, pose, lights = out / "lights" / scene, SCENES[scene].still, SCENES[scene].lights
        numbers = range(1, len(lights) + 1)
        write_text(folder / "cameras.txt", cameras(scene, size))
        write_text(folder / "poses.txt", tum(map(str, numbers), [pose] * len(lights)))
        for k in numbers[1:]:
            write_text(folder / f"H_1_{k}", "1 0 0\n0 1 0\n0 0 1\n")
        for mode, name in ((DEPTH, "depth"), (LABELS, "labels")):
            yield Task(folder / name / "1.png", scene, mode, "noon", pose, 0, [folder / name / f"{k}.png" for k in numbers[1:]])
        for k, light in zip(numbers, lights):
            yield Task(folder / f"{k}.png", scene, IMAGE, light, pose, 0, [])


def start(main):
    """Runs a command; errors that a user can correct become one line."""
    try:
        main()
    except (RuntimeError, OSError) as error:
        sys.exit(str(error))


def render_all(tasks, size, jobs, run_task=run):
    if shutil.which("povray") is None:
        raise RuntimeError("povray is not installed: apt-get install povray")
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        try:
            futures = [pool.submit(run_task, task, size) for task in tasks]
            for done, future in enumerate(concurrent.futures.as_completed(futures), 1):
                print(f"[{done}/{len(tasks)}] {future.result()}", flush=True)
        except BaseException:  # also Ctrl-C: waiting tasks are dropped, running ones finish
            pool.shutdown(cancel_futures=True)
            raise


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path, help="output folder; existing pictures are kept")
    parser.add_argument("--scenes", nargs="+", choices=STILLS, default=STILLS, metavar="SCENE", help=f"some of: {', '.join(STILLS)} (all)")
    parser.add_argument("--size", type=int, nargs=2, default=(640, 480), metavar=("WIDTH", "HEIGHT"))
    parser.add_argument("--quick", action="store_true", help="one ray a pixel and a blur instead of antialiasing")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="renderings at a time")
    options = parser.parse_args()
    if min(options.size) < 16 or options.jobs < 1:
        parser.error("--size must be 16 or more each way, --jobs 1 or more")
    size = tuple(options.size)
    tasks = list(plan(options.out, options.scenes, size))
    render_all(tasks, size, options.jobs, run_quickly if options.quick else run)


if __name__ == "__main__":
    start(main)

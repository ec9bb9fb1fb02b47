#!/usr/bin/python3
"""Renders data for visual localization: a map of the street at noon, and another path through it under other
lights, with IMU readings. See README.md."""

import argparse
import os
import pathlib

import numpy as np

from render import IMAGE, Task, render_all, run_quickly, start, write_text
from scenes import LIGHTS, SCENES, camera_to_world, cameras, tum, walk

SCENE = "street"
MAP_LIGHT = "noon"
QUERY_LIGHTS = ["night", "dusk", "winter", "overcast", "fog", "morning", "wet"]
KEYFRAMES, QUERIES, SIZE = 16, 30, (640, 480)  # pictures of the map, 1.4 m apart, and of each other light
DURATION = 14.5  # seconds; at 1.4 m/s this covers the mapped walk
IMU_RATE = 200  # Hz
GRAVITY = np.array([0, 9.81, 0])  # m/s^2, in the world of `extrinsics`: y points down
# Noise densities of a good MEMS sensor, as EuRoC's sensor.yaml states them, and constant biases.
GYRO_NOISE, ACCEL_NOISE = 1.7e-4, 2.0e-3  # rad/s/sqrt(Hz), m/s^2/sqrt(Hz)
GYRO_BIAS = np.array([0.003, -0.002, 0.004])  # rad/s
ACCEL_BIAS = np.array([0.03, -0.02, 0.04])  # m/s^2


def visit(t):
    """n x 5 poses (x, y, z, yaw, pitch) as in scenes.py, smooth in time, at n times t in seconds."""
    def wave(period, phase=0.0):
        return np.sin(2 * np.pi * t / period + phase)
    return np.stack([-0.2 + 0.7 * wave(10), 1.65 + 0.03 * wave(0.9), 0.5 + 1.38 * t + 0.1 * wave(4),
                     1 + 6 * wave(11, 2.5) + 2 * wave(3.7), 6.5 + 1.5 * wave(3.1)], axis=1)


def imu(seed):
    """Rows of a EuRoC imu.csv: nanoseconds, angular velocity, specific force, in the camera's axes."""
    step = 1e-4
    times = np.arange(0, DURATION + 0.5 / IMU_RATE, 1 / IMU_RATE)

    def matrices(at):
        return np.array([camera_to_world(pose) for pose in visit(at)])
    before, now, after = matrices(times - step), matrices(times), matrices(times + step)
    random = np.random.default_rng(seed)
    rows = []
    for time, a, b, c in zip(times, before, now, after):
        change = a[:3, :3].T @ c[:3, :3]  # so small that its skew part is the angle; cv2.Rodrigues would return 0
        turn = (change - change.T)[[2, 0, 1], [1, 2, 0]] / (4 * step)
        acceleration = (a[:3, 3] - 2 * b[:3, 3] + c[:3, 3]) / step ** 2
        force = b[:3, :3].T @ (acceleration - GRAVITY)
        turn = turn + GYRO_BIAS + random.standard_normal(3) * GYRO_NOISE * np.sqrt(IMU_RATE)
        force = force + ACCEL_BIAS + random.standard_normal(3) * ACCEL_NOISE * np.sqrt(IMU_RATE)
        rows.append(",".join([str(round(time * 1e9)), *(f"{v:.9g}" for v in (*turn, *force))]))
    return "#timestamp [ns],w_x [rad s^-1],w_y,w_z,a_x [m s^-2],a_y,a_z\n" + "\n".join(rows) + "\n"


def spread(count):
    """0 .. count - 1, coarse steps first, so that an interrupted run has covered the whole walk."""
    bits = max(count - 1, 1).bit_length()
    return [k for k in (int(f"{n:0{bits}b}"[::-1], 2) for n in range(1 << bits)) if k < count]


def plan(out, keyframes, queries, lights, size):
    """Yields the tasks in the order of rendering, and writes cameras, poses and IMU readings."""
    poses = walk(SCENES[SCENE].path, keyframes)
    names = [f"{k:04d}" for k in range(keyframes)]
    write_text(out / "map" / "cameras.txt", cameras(SCENE, size))
    write_text(out / "map" / "poses.txt", tum(names, poses))
    for name, pose, frame in zip(names, poses, range(keyframes)):
        yield Task(out / "map" / "images" / f"{name}.png", SCENE, IMAGE, MAP_LIGHT, pose, frame, [])
    times = np.linspace(0, DURATION, queries)
    poses = visit(times)
    names = [f"{time:09.6f}" for time in times]
    for light in lights:
        write_text(out / light / "cameras.txt", cameras(SCENE, size))
        write_text(out / light / "poses.txt", tum(names, poses))
        write_text(out / light / "imu.csv", imu(LIGHTS[light]))
    for k in spread(queries):
        for light in lights:
            yield Task(out / light / "images" / f"{names[k]}.png", SCENE, IMAGE, light, poses[k], 1000 + k, [])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path, help="output folder; existing pictures are kept")
    out = parser.parse_args().out
    tasks = list(plan(out, KEYFRAMES, QUERIES, QUERY_LIGHTS, SIZE))
    render_all(tasks, SIZE, os.cpu_count(), run_quickly)


if __name__ == "__main__":
    start(main)

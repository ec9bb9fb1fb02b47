"""The scenes: poses, walks, and lights in the order of the pictures."""

from collections import namedtuple

import cv2
import numpy as np

# Numbers as in lights.inc. The reference (picture 1) is noon.
LIGHTS = {"noon": 1, "morning": 2, "dusk": 3, "night": 4, "overcast": 5, "fog": 6, "winter": 7, "wet": 8, "snow": 9}

# Standard deviation of the sensor's noise, grey levels; darkness needs more gain.
NOISE = {"night": 6.0, "dusk": 4.0, "fog": 3.0, "wet": 2.0}
NOISE_BY_DAY = 1.2

# Poses have the position x, y, z (metres; x right, y up, z forward), yaw (degrees from +z towards +x), pitch (degrees upward)
# and, optionally, roll (degrees clockwise).
Scene = namedtuple("Scene", "focal still path lights")  # focal length in picture widths

OUTDOOR = ["noon", "morning", "dusk", "night", "overcast", "fog", "winter"]

SCENES = {
    "street": Scene(0.81, (-0.9, 1.75, 0, 4, 7),
                    [(-0.9, 1.75, 0, 4, 7), (0.3, 1.7, 7, -9, 8), (1.2, 1.75, 14, -2, 6),
                     (0.2, 1.75, 21, 12, 8)],
                    OUTDOOR + ["wet"]),
    "room": Scene(0.70, (1.9, 1.5, 0.4, -20, -7),
                  [(1.9, 1.5, 0.4, -20, -7), (1.2, 1.5, 0.9, -6, -8), (0.3, 1.5, 1.2, 16, -7),
                   (-0.7, 1.5, 1.6, 30, -9)],
                  OUTDOOR + ["wet"]),
    "facade": Scene(0.85, (-2.0, 2.0, 0, 6, 17),
                    [(-6.0, 2.0, 1, 22, 16), (-2.0, 2.0, 0, 6, 17), (2.0, 2.0, 1, -8, 16),
                     (6.0, 2.0, 2.5, -20, 17)],
                    OUTDOOR + ["snow"]),
    "terrain": Scene(0.80, (0, 1.7, 0, 0, 2),
                     [(0, 1.7, 0, 0, 2), (0.6, 1.7, 6, 8, 2), (0, 1.7, 12, -5, 2), (-0.8, 1.7, 18, -14, 3)],
                     OUTDOOR + ["snow"]),
    # Kinds that nothing was trained on, for views.py alone.
    "yard": Scene(0.82, None, [(-0.6, 1.7, 0, -6, 6), (0.4, 1.75, 2.2, 6, 7), (-0.4, 1.7, 4.4, -10, 8), (0.5, 1.75, 6, 3, 6)], []),
    "hall": Scene(0.75, None, [(-0.6, 1.65, -2.5, 6, 1), (0.4, 1.7, -0.5, -8, 2), (-0.4, 1.65, 1.5, 9, 1), (0.5, 1.7, 3.5, -6, 2)], []),
}
STILLS = [name for name in SCENES if SCENES[name].lights]


def walk(waypoints, frames):
    """frames x 5: poses (x, y, z, yaw, pitch) at equal steps from the first waypoint to the last."""
    at = np.linspace(0, len(waypoints) - 1, frames)
    columns = [np.interp(at, range(len(waypoints)), column) for column in np.transpose(waypoints)]
    return np.stack(columns, axis=1)


def intrinsics(scene, width, height):
    """3x3 camera matrix in pixels; pixel centres have integer coordinates, as in OpenCV."""
    focal = SCENES[scene].focal * width
    return np.array([[focal, 0, (width - 1) / 2], [0, focal, (height - 1) / 2], [0, 0, 1.0]])


def extrinsics(pose):
    """3x4 [R|t] from the world (x right, y down, z forward: the scene files' y is negated) to the camera."""
    yaw, pitch, roll = np.radians([*pose[3:], 0][:3])
    forward = np.array([np.sin(yaw) * np.cos(pitch), np.sin(pitch), np.cos(yaw) * np.cos(pitch)])
    level = np.array([np.cos(yaw), 0, -np.sin(yaw)])
    right = np.cos(roll) * level - np.sin(roll) * np.cross(forward, level)
    down = -np.cross(forward, right)
    rotation = np.stack([right, down, forward]) * [1, -1, 1]
    centre = np.asarray(pose[:3]) * [1, -1, 1]
    return np.hstack([rotation, (-rotation @ centre)[:, None]])


def camera_to_world(pose):
    """4x4 matrix of a pose (x, y, z, yaw, pitch)."""
    world_to_camera = np.vstack([extrinsics(pose), [0, 0, 0, 1]])
    return np.linalg.inv(world_to_camera)


def quaternion(rotation):
    """x, y, z, w of a 3x3 rotation by less than 180 degrees."""
    axis = cv2.Rodrigues(rotation)[0].ravel()
    angle = np.linalg.norm(axis)
    return np.append(axis * np.sinc(angle / 2 / np.pi) / 2, np.cos(angle / 2))


def tum(names, poses):
    """Poses in TUM's format, camera to world."""
    lines = ["# name tx ty tz qx qy qz qw"]
    for name, pose in zip(names, poses):
        matrix = camera_to_world(pose)
        lines.append(" ".join([name, *(f"{v:.9g}" for v in (*matrix[:3, 3], *quaternion(matrix[:3, :3])))]))
    return "\n".join(lines) + "\n"


def cameras(scene, size):
    """COLMAP's cameras.txt, with pixel centres at halves."""
    matrix = intrinsics(scene, *size)
    return ("# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n"
            f"1 PINHOLE {size[0]} {size[1]} {matrix[0, 0]:.9g} {matrix[1, 1]:.9g} "
            f"{matrix[0, 2] + 0.5:.9g} {matrix[1, 2] + 0.5:.9g}\n")

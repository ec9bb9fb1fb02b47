"""What the command localize takes for its option --imu: readings, images named by their times, and where the camera is."""
from __future__ import annotations

import os
import re
from typing import Optional, Sequence

import numpy as np
from numpy.typing import NDArray

from opencv_iib._arguments import MissingFile
from opencv_iib.localization.smoothing import MAX_TIME

MAX_LEVER = 1000  #: metres from an IMU to its camera
NANOSECONDS = 15  #: digits of a time from which on it is in nanoseconds; one in seconds has 10 at most


def read_imu(path: str) -> NDArray[np.float64]:
    """EuRoC's imu.csv, M x 7, as smooth_poses takes it.

    :raises ValueError: naming file and line.
    :raises MissingFile: if it is not there.
    """
    if os.path.isdir(path) or not os.path.exists(path):
        raise MissingFile(f'there is no file {path}')
    rows: list[list[float]] = []
    with open(path, encoding='utf-8', errors='replace') as file:
        for number, line in enumerate(file, 1):
            if not line.strip() or line.startswith('#'):
                continue
            values = _numbers(line)
            if len(values) != 7:
                raise ValueError(f'{path}:{number}: not a time and six numbers')
            if abs(values[0]) > MAX_TIME:
                raise ValueError(f'{path}:{number}: the time is not in nanoseconds')
            if rows and values[0] <= rows[-1][0]:
                raise ValueError(f'{path}:{number}: the time does not rise')
            rows.append(values)
    if not rows:
        raise ValueError(f'{path} has no readings')
    return np.array(rows)


def _numbers(text: str) -> list[float]:
    """That stand between commas, if all are finite."""
    try:
        values = [float(part) for part in text.split(',')]
    except ValueError:
        return []
    return values if np.isfinite(values).all() else []


def time_of(stem: str) -> Optional[int]:
    """Nanoseconds that a name without extension stands for: seconds, or nanoseconds."""
    parts = re.fullmatch('([0-9]+)[.]?([0-9]*)', stem)
    if not parts:
        return None
    if NANOSECONDS <= len(parts[1]) and int(parts[1]) <= MAX_TIME:
        return int(parts[1])
    return int(parts[1] + f'{parts[2]:0<9.9}') if len(parts[1]) <= 10 else None


def by_time(names: Sequence[str], readings: NDArray[np.float64]) -> dict[str, int]:
    """The times of images in nanoseconds, in their order.

    :raises ValueError: for names that are no times, equal ones, or times that are not those of the readings.
    """
    times = {name: time_of(os.path.splitext(name)[0]) for name in names}
    for name, time in times.items():
        if time is None:
            raise ValueError(f'{name}: with --imu the images must be named by their times, in seconds or nanoseconds')
    ordered = sorted((time, name) for name, time in times.items() if time is not None)
    for (time, name), (following, other) in zip(ordered, ordered[1:]):
        if time == following:
            raise ValueError(f'{name} and {other} have one time')
    if ordered[-1][0] < readings[0, 0] or ordered[0][0] > readings[-1, 0]:
        raise ValueError(f"{ordered[0][1]}: the images' times, in seconds or nanoseconds, are not those of the IMU's readings, in nanoseconds")
    return {name: time for time, name in ordered}


def parse_pose(text: str) -> NDArray[np.float64]:
    """``tx,ty,tz,qx,qy,qz,qw`` as 4 x 4.

    :raises ValueError: for anything else.
    """
    values = np.array(_numbers(text))
    if len(values) != 7 or not (np.abs(values[3:]) < 2).all() or abs(np.linalg.norm(values[3:]) - 1) > 1e-2 or np.abs(values[:3]).max() > MAX_LEVER:
        raise ValueError(f'{text} is not tx,ty,tz,qx,qy,qz,qw with a quaternion of length 1 and metres')
    x, y, z, w = values[3:] / np.linalg.norm(values[3:])
    pose = np.eye(4)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    pose[:3, :3] += 2 * (w * cross + cross @ cross)
    pose[:3, 3] = values[:3]
    return pose

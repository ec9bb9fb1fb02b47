"""Smooths poses of images by an IMU; reads its file, the times of images, and the pose of the camera."""
from __future__ import annotations

import os
import re
from typing import Any, Iterable, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arguments import InvalidOption, MissingFile, integers, sequence
from opencv_iib._arrays import as_array
from opencv_iib.localization.localizer import Location, as_pose

MAX_TIME = 4e18  #: nanoseconds
MAX_LEVER = 1000  #: metres from an IMU to its camera
NANOSECONDS = 15  #: digits of a time from which on it is in nanoseconds; one in seconds has 10 at most


class SmoothedPoses(list[Optional[NDArray[np.float64]]]):
    """Camera from world of each image, 4 x 4, or None. ``reason`` is a sentence if readings contradict images, else ''."""

    def __init__(self, poses: Iterable[Optional[NDArray[np.float64]]], reason: str) -> None:
        super().__init__(poses)
        self.reason = reason


def smooth_poses(times: Sequence[Any], locations: Sequence[Location], readings: ArrayLike,
                 imu_from_camera: ArrayLike = np.eye(4)) -> SmoothedPoses:
    """Smooths poses by the readings of an IMU that moves with the camera, as ``cv::iib::smoothPoses``.

    Images without a pose get one if they follow one with a pose by at most three seconds. Gravity's direction and the IMU's biases are
    estimated from the first poses. Images that the readings contradict keep their own poses; if most are contradicted, for example
    because of other axes or units, all do.

    :param times: of the images, nanoseconds, rising.
    :param locations: results of Localizer.localize, in a map in metres.
    :param readings: M x 7: nanoseconds, rad/s about x, y, z and m/s^2 along them, acceleration without gravity's, in the IMU's
        axes, on the images' clock; ``numpy.loadtxt('imu.csv', delimiter=',')`` reads EuRoC's file.
    :param imu_from_camera: pose of the camera in the IMU's axes (EuRoC's ``T_BS``), 4 x 4 or 3 x 4.
    :return: a list of camera from world, 4 x 4, or None, with a ``reason``: a sentence if readings contradict images or a covariance is
        invalid, such as zeros, else ''.
    :raises opencv_iib.error: for times that do not rise, or an imu_from_camera that is not a rigid motion.
    :raises ValueError: for readings that are not M x 7 finite numbers."""
    rows = as_array(readings, 'readings').astype(np.float64, copy=False)
    if rows.ndim != 2 or rows.shape[1] != 7 or not np.isfinite(rows).all() or np.abs(rows).max(initial=0) > MAX_TIME:
        raise ValueError(f'readings are M x 7 finite numbers: nanoseconds, rate and force, not {rows.shape}')
    locations = sequence(locations, 'locations', 'what Localizer.localize finds')
    for location in locations:
        if not isinstance(location, Location):
            raise TypeError(f'locations: what Localizer.localize finds is needed, not {location!r}')
    known = [(location.cam_from_world, location.covariance) for location in locations]
    return SmoothedPoses(*_core.smoothPoses(integers(times, 'times', 64), known, rows, as_pose(imu_from_camera)))


def read_imu(path: str) -> NDArray[np.float64]:
    """Reads EuRoC's imu.csv, M x 7, for smooth_poses.
    :raises ValueError: naming file and line.
    :raises MissingFile: if it is missing."""
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
    """Numbers between commas; none if one is not finite."""
    try:
        values = [float(part) for part in text.split(',')]
    except ValueError:
        return []
    return values if np.isfinite(values).all() else []


def time_of(stem: str) -> Optional[int]:
    """The time in nanoseconds of a name without extension, which is in seconds or nanoseconds."""
    parts = re.fullmatch('([0-9]+)[.]?([0-9]*)', stem)
    if not parts:
        return None
    if NANOSECONDS <= len(parts[1]) and int(parts[1]) <= MAX_TIME:
        return int(parts[1])
    return int(parts[1] + f'{parts[2]:0<9.9}') if len(parts[1]) <= 10 else None


def by_time(names: Sequence[str], readings: NDArray[np.float64]) -> dict[str, int]:
    """The times of images in nanoseconds, in their order.
    :raises InvalidOption: for names that are no times, equal times, or times beyond the readings."""
    times = []
    for name in names:
        time = time_of(os.path.splitext(name)[0])
        if time is None:
            raise InvalidOption(f'{name}: with --imu the images must be named by their times, in seconds or nanoseconds')
        times.append((time, name))
    ordered = sorted(times)
    for (time, name), (following, other) in zip(ordered, ordered[1:]):
        if time == following:
            raise InvalidOption(f'{name} and {other} have one time')
    if ordered[-1][0] < readings[0, 0] or ordered[0][0] > readings[-1, 0]:
        raise InvalidOption(f"{ordered[0][1]}: the images' times, in seconds or nanoseconds, are not those of the IMU's readings, in nanoseconds")
    return {name: time for time, name in ordered}


def parse_pose(text: str) -> NDArray[np.float64]:
    """Parses ``tx,ty,tz,qx,qy,qz,qw``, 4 x 4. :raises ValueError: for anything else."""
    values = np.array(_numbers(text))
    if len(values) != 7 or not (np.abs(values[3:]) < 2).all() or abs(np.linalg.norm(values[3:]) - 1) > 1e-2 or np.abs(values[:3]).max() > MAX_LEVER:
        raise ValueError(f'{text} is not tx,ty,tz,qx,qy,qz,qw with a quaternion of length 1 and metres')
    x, y, z, w = values[3:] / np.linalg.norm(values[3:])
    pose = np.eye(4)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    pose[:3, :3] += 2 * (w * cross + cross @ cross)
    pose[:3, 3] = values[:3]
    return pose

"""Poses of images, smoothed by an IMU."""
from __future__ import annotations

from typing import Any, Iterable, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arguments import integers, sequence
from opencv_iib._arrays import as_array
from opencv_iib.localization.localizer import Location, as_pose

MAX_TIME = 4e18  #: nanoseconds


class SmoothedPoses(list[Optional[NDArray[np.float64]]]):
    """Of each image camera from world, 4 x 4, or None; ``reason`` is a sentence where readings contradict images, else ''."""

    def __init__(self, poses: Iterable[Optional[NDArray[np.float64]]], reason: str) -> None:
        super().__init__(poses)
        self.reason = reason


def smooth_poses(times: Sequence[Any], locations: Sequence[Location], readings: ArrayLike,
                 imu_from_camera: ArrayLike = np.eye(4)) -> SmoothedPoses:
    """Smooths poses by the readings of an IMU that moves with the camera, as ``cv::iib::smoothPoses``.

    Images without a pose get one too, if they come after one with a pose, by three seconds at most; gravity's direction and
    the IMU's biases are found from the first poses. Where readings contradict images, these keep their own poses; if they contradict
    most, in other axes or units for example, all do.

    :param times: of the images, nanoseconds, rising.
    :param locations: what Localizer.localize found of each, in a map in metres.
    :param readings: M x 7: nanoseconds, rad/s about x, y, z and m/s^2 along them, acceleration without gravity's, in the IMU's
        axes, as ``numpy.loadtxt('imu.csv', delimiter=',')`` reads EuRoC's file; on the images' clock.
    :param imu_from_camera: where the camera is in the IMU's axes (EuRoC's ``T_BS``), 4 x 4 or 3 x 4.
    :return: a list: of each image camera from world, 4 x 4, or None; its ``reason`` tells whether readings contradict images, or
        a covariance is none, such as zeros; else it is ''.
    :raises opencv_iib.error: for times that do not rise, or an imu_from_camera that is not a turn and a shift.
    :raises ValueError: for readings that are not M x 7 finite numbers.
    """
    rows = as_array(readings, 'readings').astype(np.float64, copy=False)
    if rows.ndim != 2 or rows.shape[1] != 7 or not np.isfinite(rows).all() or np.abs(rows).max(initial=0) > MAX_TIME:
        raise ValueError(f'readings are M x 7 finite numbers: nanoseconds, rate and force, not {rows.shape}')
    locations = sequence(locations, 'locations', 'what Localizer.localize finds')
    for location in locations:
        if not isinstance(location, Location):
            raise TypeError(f'locations: what Localizer.localize finds is needed, not {location!r}')
    known = [(location.cam_from_world, location.covariance) for location in locations]
    return SmoothedPoses(*_core.smoothPoses(integers(times, 'times', 64), known, rows, as_pose(imu_from_camera)))

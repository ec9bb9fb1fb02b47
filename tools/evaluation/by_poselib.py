#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Adds PoseLib's poses to an evaluation's estimators.csv, from the matches in matched_points.csv: by_poselib.py PAIRS

Needs poselib (pip); without it nothing changes, and one line says so."""
import csv
import math
import pathlib
import sys

import numpy as np

THRESHOLDS = .5, 1  # pixels


def error_of(R, t, true_R, true_t):
    """The larger angle in degrees of rotation and direction."""
    cosines = (np.trace(R.T @ true_R) - 1) / 2, t.ravel() @ true_t / np.linalg.norm(t) / np.linalg.norm(true_t)
    return max(math.degrees(math.acos(max(-1, min(1, cosine)))) for cosine in cosines)


def camera(matrix):
    return {'model': 'PINHOLE', 'width': 1, 'height': 1, 'params': matrix[[0, 4, 2, 5]]}


def estimate(poselib, numbers, threshold):
    """The pose's error in degrees, as for the other estimators, and its number of inliers."""
    cameras, R, t, points = numbers[:18], numbers[18:27].reshape(3, 3), numbers[27:30], numbers[30:].reshape(-1, 4)
    if len(points) < 5:
        return 'inf', 0
    pose, info = poselib.estimate_relative_pose(points[:, :2].copy(), points[:, 2:].copy(), camera(cameras[:9]), camera(cameras[9:]),
                                                {'max_epipolar_error': threshold}, {})
    return '%.6g' % error_of(pose.R, pose.t, R, t), info['num_inliers']


def main():
    try:
        import poselib
    except ImportError:
        print('poselib is not installed: no poses of PoseLib')
        return
    folder = pathlib.Path(sys.argv[1])
    csv.field_size_limit(sys.maxsize)
    with open(folder / 'estimators.csv', newline='') as opened:
        head, *rows = csv.reader(opened)
    known = {tuple(row[:7]): row for row in rows}
    with open(folder / 'matched_points.csv', newline='') as opened:
        for *key, numbers in list(csv.reader(opened))[1:]:
            for threshold in THRESHOLDS:
                name = (*key, 'PoseLib %g px' % threshold)
                if name not in known:
                    known[name] = [*name, *estimate(poselib, np.array(numbers.split(), float), threshold)]
    with open(folder / 'estimators.csv', 'w', newline='') as opened:
        csv.writer(opened, lineterminator='\n').writerows([head, *(known[key] for key in sorted(known))])


if __name__ == '__main__':
    main()

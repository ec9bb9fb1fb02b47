#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""What reported errors of poses do not include: not_included.py OUT.csv

Draws 200 pairs of cameras of 640 x 480 pixels for each mistake: 200 points 3 to 9 units away, a baseline of .3, noise of .2 pixels, a fifth of
the matches wrong. Writes the share of poses whose rotation and direction are inside the 95 % limits, and medians of the errors in degrees.
"""
import csv
import sys

import cv2
import numpy as np
import opencv_iib

K = np.array([[500., 0, 320], [0, 500, 240], [0, 0, 1]])
PAIRS, POINTS = 200, 200
CORNER = np.hypot(320, 240) / 500  # radius of the corner, in focal lengths
CASES = {'none': {}, **{'distortion of %d pixels at the corners' % by: {'distortion': by / 500 / CORNER ** 3} for by in (1, 4, 16)},
         'rolling shutter, .3 degrees a frame': {'turn': np.radians(.3)}, 'focal length 5 % too long': {'focal': 1.05}}


def seen(points, R, t, distortion):
    x = points @ R.T + t
    x = x[:, :2] / x[:, 2:]
    x = x * (1 + distortion * (x ** 2).sum(1, keepdims=True))
    return x * 500 + (320, 240)


def errors(random, distortion=0, turn=0, focal=1):
    """Of one pair: whether rotation and direction are inside their limits, and both errors in degrees. None without a pose."""
    points = np.column_stack((random.uniform(-2, 2, POINTS), random.uniform(-1.5, 1.5, POINTS), random.uniform(3, 9, POINTS)))
    R, t = cv2.Rodrigues(random.normal(0, .1, 3))[0], random.normal(0, 1, 3)
    t *= .3 / np.linalg.norm(t)
    first, second = seen(points, np.eye(3), np.zeros(3), distortion), seen(points, R, t, distortion)
    if turn:  # rows are read one after the other, and the second camera turns meanwhile
        second = np.array([seen(p[None], cv2.Rodrigues(np.array([0, turn * (s[1] / 480 - .5), 0]))[0] @ R, t, 0)[0] for p, s in zip(points, second)])
    second[:POINTS // 5] = random.uniform(0, 480, (POINTS // 5, 2))
    first, second = (p + random.normal(0, .2, p.shape) for p in (first, second))
    camera = K * [[focal, 1, 1], [1, focal, 1], [1, 1, 1]]
    pose = opencv_iib.findRelativePose(first, second, camera, camera)
    if not pose.found:
        return None
    w = cv2.Rodrigues(R @ pose.R.T)[0].ravel()
    true, found = t / np.linalg.norm(t), pose.t.ravel()
    b = np.cross(found, np.eye(3)[np.abs(found).argmin()])
    b /= np.linalg.norm(b)
    d = np.array([b @ true, np.cross(found, b) @ true])
    inside = [e @ np.linalg.solve(C, e) < opencv_iib.confidenceLimit(.95, len(e)) for e, C in ((w, pose.covariance[:3, :3]), (d, pose.covariance[3:, 3:]))]
    return *inside, np.degrees(np.linalg.norm(w)), np.degrees(np.arccos(np.clip(found @ true, -1, 1)))


def main():
    with open(sys.argv[1], 'w', newline='') as file:
        out = csv.writer(file, lineterminator='\n')
        out.writerow(['mistake', 'poses', 'rotation_inside', 'direction_inside', 'rotation', 'direction'])
        for name, mistake in CASES.items():
            random = np.random.default_rng(1)
            found = np.array([e for e in (errors(random, **mistake) for _ in range(PAIRS)) if e], float)
            out.writerow([name, len(found), *('%.3g' % v for v in (*found[:, :2].mean(0), *np.median(found[:, 2:], axis=0)))])


if __name__ == '__main__':
    main()

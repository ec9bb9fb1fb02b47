#!/usr/bin/env python3
"""How long it takes to read 10,000 cv2.KeyPoints: by the package, and by a loop in Python; the least of 50 runs."""
import argparse
import time

import cv2
import numpy as np


def least(function, runs=50):
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return 1e3 * min(times)


argparse.ArgumentParser(description=__doc__).parse_args()
import opencv_iib  # noqa: E402  so that --help works without it

keypoints = [cv2.KeyPoint(float(i % 900), float(i % 700), 31., 45., .5, 0, -1) for i in range(10000)]
print(f'opencv_iib: {least(lambda: opencv_iib.keypoints_to_array(keypoints)):.2f} ms')
loop = least(lambda: np.array([(*k.pt, k.size, k.angle, k.response, k.octave, k.class_id) for k in keypoints], 'f4'))
print(f'loop in Python: {loop:.2f} ms')

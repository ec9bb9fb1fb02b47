#!/usr/bin/env python3
"""How much faster N Python threads describe and match than one: the GIL is released while they do.

Every thread takes the same number of images, so that N of them at best do N times as much in the same time. The least
times of 15 runs, in which one thread and N take turns; opencv_iib's own threads are off.
"""
import argparse
import os
import threading
import time

import numpy as np

RUNS = 15
IMAGES = 8  # for each thread in one run


def timed(function, threads):
    def work():
        for _ in range(IMAGES):
            function()
    workers = [threading.Thread(target=work) for _ in range(threads)]
    start = time.perf_counter()
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    return time.perf_counter() - start


def scaling(function, threads):
    times = [(timed(function, 1), timed(function, threads)) for _ in range(RUNS)]
    one, many = np.min(times, axis=0)
    return threads * one / many


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument('threads', type=int, nargs='?', default=os.cpu_count(), help='N (%(default)s, one a core)')
count = parser.parse_args().threads
import opencv_iib  # noqa: E402  so that --help works without it

opencv_iib.setNumThreads(1)
random = np.random.default_rng(1)
image = random.integers(0, 256, (960, 1280), np.uint8)
keypoints = np.column_stack([random.uniform(0, 1280, 2000), random.uniform(0, 960, 2000), np.full(2000, 31.)])
iib = opencv_iib.IIB.create()
matcher = opencv_iib.HierarchicalMatcher(iib.levelSizes(), crossCheck=True)
codes = iib.compute(image, keypoints)[1]
print(f'{count} threads, against one:')
print(f'describing: {scaling(lambda: iib.compute(image, keypoints), count):.2f} times as much in the same time')
print(f'matching: {scaling(lambda: matcher.knnMatchArrays(codes, codes), count):.2f} times as much in the same time')

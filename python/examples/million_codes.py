"""Finds the codes of one image among a million others: python million_codes.py [COUNT]"""
import sys
import tempfile
import time

import numpy as np

import opencv_iib
import scene

count = int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000

# %% Codes of 32 bytes of a street by day and by night, at the same points.
day, night = scene.PICTURES.values()
small = opencv_iib.IIB.createFor(opencv_iib.HessianDetector(500), 'SMALL')
keypoints = small.detect(day)
by_day, by_night = (small.compute(image, keypoints)[1] for image in (day, night))

# %% An index in a folder: a hundred "images" of random codes, then the street by day. Each call of `add` is atomic.
folder = tempfile.mkdtemp() + '/codes'
index = opencv_iib.MappedIndex.create(folder, small.levelSizes())
random = np.random.default_rng(1)
index.add([random.integers(0, 256, (count // 100, small.descriptorSize()), np.uint8) for _ in range(100)])
index.add(by_day)

# %% Another process opens it in a millisecond; codes are read at the first search.
index = opencv_iib.MappedIndex.open(folder)
begin = time.perf_counter()
rows, distances = index.search(by_night)
print(f'{len(by_night)} codes among {index.rows()}: {time.perf_counter() - begin:.2f} s')

# %% Each code votes for the image of its nearest neighbour, which is exact, as by brute force.
votes = np.bincount([index.imageOf(int(row)) for row in rows[:, 0]], minlength=index.images())
print(f'image {votes.argmax()} of {index.images()} has {votes.max()} votes, the next {np.sort(votes)[-2]};',
      f'{(rows[:, 0] == index.firstRow(100) + np.arange(len(by_night))).sum()} are the same point')

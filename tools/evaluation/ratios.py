#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Compares ratio tests of the recommended chain: ratios.py OUT.csv DATA...

Needs opencv_iib (pip). Reads pairs below the folders DATA (tools/evaluation/README.md): of sequences in other light, where a match is right within
3 pixels, and of places in other light, whose pose is estimated.

OUT.csv has a row for each set, number of points and ratio: means over pairs, areas under the curves of pose errors up to 10, 5 and 2 degrees,
the gain (5 degrees) over a ratio of .9 with a 95 % interval over places, and milliseconds of one thread for the pose.
"""
import csv
import sys
import time

import cv2
import numpy as np

import opencv_iib
from datasets import ImagePair, image_pairs, read_image, view_pairs
from methods import error_of

RATIOS, FORMER = (.8, .85, .88, .9, .92, .93, .95, 1.), .9
POINTS = 500, 1000, 2000, 4000
TOLERANCE, LIMITS = 3, (10, 5, 2)  # pixels, degrees


def areas(errors, limit):
    return np.maximum(0, 1 - np.array(errors, float) / limit)


def interval(gains, where):
    """95 % interval of the mean of gains, by resampling the places where they were measured."""
    groups = [gains[np.array(where) == place] for place in sorted(set(where))]
    drawn = np.random.default_rng(1).integers(len(groups), size=(2000, len(groups)))
    return np.percentile([np.concatenate([groups[i] for i in sample]).mean() for sample in drawn], [2.5, 97.5])


def measure(images, features, ratio, pair):
    """Matches, right ones or nothing, the pose's error or nothing, and milliseconds for the pose."""
    matcher = opencv_iib.HierarchicalMatcher(crossCheck=True)
    matcher.setMaxRatio(ratio)
    pairs = opencv_iib.match(features[0].codes, features[1].codes, matcher).pairs
    points = [each.points[pairs[:, i]] for i, each in enumerate(features)]
    if isinstance(pair, ImagePair):
        there = cv2.perspectiveTransform(points[0][None].astype(float), pair.H)[0]
        return len(pairs), (np.linalg.norm(there - points[1], axis=1) <= TOLERANCE).sum(), None, None
    moved = opencv_iib.propagateMatches(images[0], np.column_stack(features[0][:2]), images[1], np.column_stack(features[1][:2]), pairs)
    start = time.process_time()
    pose = opencv_iib.findRelativePose(moved.points1, moved.points2, *pair.cameras)
    return len(pairs), None, error_of(pose.R, pose.t, pair) if pose.found else 180, 1000 * (time.process_time() - start)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    opencv_iib.setNumThreads(1)
    found = {}
    for pair in [*(pair for pair in image_pairs(sys.argv[2:]) if pair.light), *(pair for pair in view_pairs(sys.argv[2:]) if not pair.same_light)]:
        group = pair.set if isinstance(pair, ImagePair) else 'other light, moved'
        images = [read_image(file) for file in pair.files]
        for count in POINTS:
            features = [opencv_iib.detect_and_describe(image, count) for image in images]
            for ratio in RATIOS:
                found.setdefault((group, count, ratio), []).append(('/'.join(pair[:2]) if isinstance(pair, ImagePair) else pair.set, *measure(images, features, ratio, pair)))
    with open(sys.argv[1], 'w', encoding='utf-8', newline='') as file:
        table = csv.writer(file, lineterminator='\n')
        table.writerow(['place', 'points', 'ratio', 'pairs', 'matches', 'right', *('at_%d' % limit for limit in LIMITS), 'gain', 'low', 'high', 'milliseconds'])
        for key, rows in sorted(found.items()):
            where, matches, right, errors, times = zip(*rows)
            line = [*key, len(rows), '%.1f' % np.mean(matches)]
            if errors[0] is None:
                table.writerow([*line, '%.1f' % np.mean(right), *[''] * 7])
                continue
            gains = areas(errors, 5) - areas([row[3] for row in found[(*key[:2], FORMER)]], 5)
            numbers = [*(areas(errors, limit).mean() for limit in LIMITS), gains.mean(), *interval(gains, where)]
            table.writerow([*line, '', *('%.4f' % number for number in numbers), '%.2f' % np.mean(times)])


if __name__ == '__main__':
    main()

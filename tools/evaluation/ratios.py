#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Compares ratio tests of the recommended chain: ratios.py OUT.csv DATA...

Needs opencv_iib (pip). Reads two layouts below the folders DATA (tools/evaluation/README.md):
- A sequence has images 1.*, 2.* and so on, and homographies H_1_2 and so on. A match is right within 3 pixels. Its set is the folder above.
- A place has poses.txt, as tools/synthetic/views.py writes it. An image in other light is matched with the nearest image of its map, at least
  .5 m away, and its pose is estimated.

OUT.csv has a row for each set, number of points and ratio: means over pairs, areas under the curves of pose errors up to 10, 5 and 2 degrees,
the gain (5 degrees) over a ratio of .9 with a 95 % interval over places, and milliseconds of one thread for the pose.
"""
import csv
import pathlib
import sys
import time

import cv2
import numpy as np

import opencv_iib
from by_poselib import error_of

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / 'localization'))
from measure import read_place  # noqa: E402

RATIOS, FORMER = (.8, .85, .88, .9, .92, .93, .95, 1.), .9
POINTS = 500, 1000, 2000, 4000
TOLERANCE, LEAST_BASELINE, LIMITS = 3, .5, (10, 5, 2)  # pixels, metres, degrees


def sequences(root):
    """Set, place, the first image, another one and their homography."""
    for file in sorted(root.rglob('H_1_*')):
        first, other = (next(file.parent.glob(name + '.*')) for name in ('1', file.name[4:]))
        yield file.parent.parent.name, file.parent, first, other, np.loadtxt(file)


def places(root):
    """Set, place, an image of the map, one in other light, their cameras' matrices and the pose of the second from the first."""
    for mapped in sorted(path.parent for path in root.rglob('map/poses.txt')):
        camera, known = read_place(mapped)
        for light in sorted(path.parent for path in mapped.parent.glob('*/poses.txt') if path.parent != mapped):
            for name, pose in read_place(light)[1].items():
                relative = {other: pose @ np.linalg.inv(known[other]) for other in known}
                far = {other: np.linalg.norm(each[:3, 3]) for other, each in relative.items()}
                best = min((other for other in far if far[other] >= LEAST_BASELINE), key=far.get)
                yield 'other light, moved', mapped.parent, mapped / 'images' / best, light / 'images' / name, (camera, relative[best])


def areas(errors, limit):
    return np.maximum(0, 1 - np.array(errors, float) / limit)


def interval(gains, where):
    """95 % interval of the mean of gains, by resampling the places where they were measured."""
    groups = [gains[np.array(where) == place] for place in sorted(set(where))]
    drawn = np.random.default_rng(1).integers(len(groups), size=(2000, len(groups)))
    return np.percentile([np.concatenate([groups[i] for i in sample]).mean() for sample in drawn], [2.5, 97.5])


def measure(images, features, ratio, truth):
    """Matches, right ones or nothing, the pose's error or nothing, and milliseconds for the pose."""
    matcher = opencv_iib.HierarchicalMatcher(crossCheck=True)
    matcher.setMaxRatio(ratio)
    pairs = opencv_iib.match(features[0].codes, features[1].codes, matcher).pairs
    points = [each.points[pairs[:, i]] for i, each in enumerate(features)]
    if isinstance(truth, np.ndarray):
        there = cv2.perspectiveTransform(points[0][None].astype(float), truth)[0]
        return len(pairs), (np.linalg.norm(there - points[1], axis=1) <= TOLERANCE).sum(), None, None
    moved = opencv_iib.propagateMatches(images[0], np.column_stack(features[0][:2]), images[1], np.column_stack(features[1][:2]), pairs)
    start, camera = time.process_time(), truth[0].matrix
    pose = opencv_iib.findRelativePose(moved.points1, moved.points2, camera, camera)
    return len(pairs), None, error_of(pose.R, pose.t, truth[1][:3, :3], truth[1][:3, 3]) if pose.found else 180, 1000 * (time.process_time() - start)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    opencv_iib.setNumThreads(1)
    found = {}
    for root in map(pathlib.Path, sys.argv[2:]):
        for group, place, *files, truth in [*sequences(root), *places(root)]:
            images = [cv2.imread(str(file), cv2.IMREAD_GRAYSCALE) for file in files]
            for count in POINTS:
                features = [opencv_iib.detect_and_describe(image, count) for image in images]
                for ratio in RATIOS:
                    found.setdefault((group, count, ratio), []).append((str(place), *measure(images, features, ratio, truth)))
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

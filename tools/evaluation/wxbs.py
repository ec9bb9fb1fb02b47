#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Matches the pairs of WxBS, and measures how near their correspondences are to the epipolar lines: wxbs.py OUT.csv V1.1

V1.1 has a folder for each category, with folders of 01.png, 02.png (or .jpg) and corrs.txt: correspondences by hand, x1 y1 x2 y2 a line. OUT.csv gets
a row for each pair and method: matchViews, the upright chain, SIFT and ORB, 4000 points an image. The fundamental matrix is MAGSAC's with
the settings of the benchmark's own example. `share`: share of the correspondences within 0, 1, ..., 19 pixels, averaged over these limits,
as in the benchmark; `within_10`: up to 10 pixels. Needs opencv_iib (pip).
"""
import csv
import pathlib
import sys

import cv2
import numpy as np

POINTS, LIMITS = 4000, range(20)


def by_views(images):
    import opencv_iib
    found = opencv_iib.matchViews(*images, POINTS)
    return found.points1, found.points2


def by_chain(images):
    import opencv_iib
    features = [opencv_iib.detect_and_describe(image, POINTS) for image in images]
    pairs = opencv_iib.match(features[0].codes, features[1].codes).pairs
    rows = [np.column_stack(each[:2]) for each in features]
    moved = opencv_iib.propagateMatches(images[0], rows[0], images[1], rows[1], pairs)
    return moved.points1, moved.points2


def by_feature(create, norm, ratio):
    """A method of OpenCV's: mutual nearest neighbours under a ratio."""
    def match(images):
        (points1, codes1), (points2, codes2) = (create(POINTS).detectAndCompute(image, None) for image in images)
        if codes1 is None or codes2 is None or len(codes2) < 2:
            return np.empty((2, 0, 2))
        back = cv2.BFMatcher(norm).match(codes2, codes1)
        kept = [first for first, second in cv2.BFMatcher(norm).knnMatch(codes1, codes2, 2)
                if first.distance < ratio * second.distance and back[first.trainIdx].trainIdx == first.queryIdx]
        return np.array([[points1[m.queryIdx].pt for m in kept], [points2[m.trainIdx].pt for m in kept]]).reshape(2, -1, 2)
    return match


METHODS = {'matchViews': by_views, 'upright chain': by_chain, 'SIFT': by_feature(cv2.SIFT_create, cv2.NORM_L2, .8),
           'ORB': by_feature(cv2.ORB_create, cv2.NORM_HAMMING, .9)}


def shares(points1, points2, truth):
    """within_10 and share of correspondences by matched points; 0 where these give no fundamental matrix."""
    F = cv2.findFundamentalMat(points1, points2, cv2.USAC_MAGSAC, .25, .999, 100000)[0] if len(points1) >= 8 else None
    if F is None or F.shape != (3, 3):
        return 0., 0.
    first, second = np.insert(truth[:, :2], 2, 1, axis=1), np.insert(truth[:, 2:], 2, 1, axis=1)
    lines2, lines1 = first @ F.T, second @ F
    errors = abs((second * lines2).sum(axis=1)) * np.sqrt(sum(1 / (lines[:, :2] ** 2).sum(axis=1) for lines in (lines1, lines2)))
    return (errors <= 10).mean(), np.mean([(errors <= limit).mean() for limit in LIMITS])


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[1], 'w', encoding='utf-8', newline='') as file:
        table = csv.writer(file, lineterminator='\n')
        table.writerow(['set', 'sequence', 'method', 'points', 'matches', 'within_10', 'share'])
        for marked in sorted(pathlib.Path(sys.argv[2]).glob('*/*/corrs.txt')):
            truth = np.loadtxt(marked, ndmin=2)
            images = [cv2.imread(str(next(marked.parent.glob(name + '.*'))), cv2.IMREAD_GRAYSCALE) for name in ('01', '02')]
            for name, match in METHODS.items():
                points = [np.asarray(each, float) for each in match(images)]
                within = ('%.6g' % value for value in shares(*points, truth))
                table.writerow([marked.parent.parent.name, marked.parent.name, name, POINTS, len(points[0]), *within])
            file.flush()


if __name__ == '__main__':
    main()

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
from datasets import read_image
from methods import WAYS

POINTS, LIMITS = 4000, range(20)


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
        table.writerow(['set', 'sequence', 'method', 'points', 'found', 'matches', 'within_10', 'share'])
        for marked in sorted(pathlib.Path(sys.argv[2]).glob('*/*/corrs.txt')):
            truth = np.loadtxt(marked, ndmin=2)
            images = [read_image(next(marked.parent.glob(name + '.*'))) for name in ('01', '02')]
            for name in ('matchViews', 'upright chain', 'SIFT', 'ORB'):
                found, points = WAYS[name](images, POINTS)
                within = ('%.6g' % value for value in shares(*points, truth))
                table.writerow([marked.parent.parent.name, marked.parent.name, name, POINTS, int(found), len(points[0]), *within])
            file.flush()


if __name__ == '__main__':
    main()

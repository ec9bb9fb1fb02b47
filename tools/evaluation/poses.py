# SPDX-License-Identifier: Apache-2.0

"""Poses of two views: the experiments `estimators` and `controls` of README.md."""
import itertools

import cv2
import numpy as np
import opencv_iib
from datasets import rows_of, view_pairs, write
from methods import CHAIN, DETECTORS, LIGHTS, UNIVERSAL, by_find_relative_pose, described, estimators as estimating, matched, moved, nearest, picture

RATIOS = .8, .85, .9, .92, .95
NOISE = 6, 14  # grey levels, of the second image
POINTS = 500, 1000, 2000  # an image, where neighbours are counted
DEPTH_STEP, DEPTH_TOLERANCE = .004, .02  # metres, tools/synthetic/common.inc; share of the depth
BLOCK = 16  # pixels
NORMALIZED = 'SIFT normalized'
# Methods; those whose poses are also estimated with noise; those whose neighbours are also counted for other numbers of points.
NOISY = CHAIN, *((points, descriptor) for points in ('Hessian', NORMALIZED, 'SIFT') for descriptor in ('SIFT', 'RootSIFT'))
COUNTED = CHAIN, ('Hessian', 'SIFT'), (NORMALIZED, 'SIFT')
METHODS = (*COUNTED, ('Hessian', 'RootSIFT'), ('Hessian', 'IIB SMALL'), (NORMALIZED, 'RootSIFT'), (NORMALIZED, UNIVERSAL), ('SIFT', 'SIFT'), ('SIFT', 'RootSIFT'),
           ('SIFT CLAHE', 'SIFT'), ('AKAZE', 'AKAZE'), ('ORB', 'ORB'))
NEIGHBOURS = ['set', 'sequence', 'target', 'detector', 'descriptor', 'points', 'baseline', 'contrast', 'visible', 'repeated', 'nearest']


def estimated(pair, light, detectors, count):
    """Rows of estimators.csv."""
    rows, images = [], (picture(pair.files[0]), picture(pair.files[1], 0, light))
    key = pair.set + ' relit' * (light is not None), pair.sequence, pair.target
    for detector in detectors:
        for descriptor in dict.fromkeys((UNIVERSAL if detector == 'Hessian' else detector.split()[0], UNIVERSAL)):
            one, two = described(detector, descriptor, count, pair.files[0]), described(detector, descriptor, count, pair.files[1], 0, light)
            pairs = matched(descriptor, one[1], two[1])
            kinds = {'plain': np.array([each[0][pairs[:, i], :2] for i, each in enumerate((one, two))], float),
                     **{name: moved(images, (one[0], two[0]), pairs, call) for name, call in (
                         ('refined', opencv_iib.refineMatches), ('propagated', opencv_iib.propagateMatches))}}
            rows += [[*key, detector, descriptor, kind, name, *estimate(points, pair)] for kind, points in kinds.items() for name, estimate in estimating().items()]
    return rows


def estimators(options):
    """Pairs in one light are judged again with the second image relit."""
    pairs, lights = view_pairs(options.data), itertools.cycle(range(len(LIGHTS)))
    detectors = [name for name in options.detectors if name.split()[0] in DETECTORS] or ('SIFT', NORMALIZED, 'Hessian')
    tasks = [(estimated, pair, light, detectors, options.points)
             for pair in pairs for light in ((None, next(lights)) if pair.same_light else (None,))]
    write(options.out / 'estimators.csv', ['set', 'sequence', 'target', 'detector', 'descriptor', 'points', 'estimator', 'error', 'inliers'], rows_of(tasks))


def depth_of(file):
    """Metres along the optical axis, where views.py wrote the depth of an image."""
    depth = cv2.imread(str(file.parents[1] / 'depth' / (file.stem + '.png')), cv2.IMREAD_UNCHANGED)
    return depth if depth is None else np.float32(depth * DEPTH_STEP)


def contrast_of(image):
    """Mean over blocks of the standard deviation of grey levels."""
    height, width = (n // BLOCK * BLOCK for n in image.shape)
    return image[:height, :width].reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK).std(axis=(1, 3)).mean()


def neighbours(pair, one, two, depths, tolerance):
    """Counts points by the known depths: those that the other image shows, those also detected there, those whose nearest descriptor is there."""
    if not len(one[0]) or not len(two[0]):
        return 0, 0, 0
    matches = cv2.BFMatcher(cv2.NORM_HAMMING if one[1].dtype == np.uint8 else cv2.NORM_L2).match(one[1], two[1])
    points, found = one[0][:, :2].astype(float), two[0][[m.trainIdx for m in matches], :2]
    x, y = np.rint(points).astype(int).T
    d = depths[0][y, x].astype(float)
    there = (pair.R @ (np.linalg.inv(pair.cameras[0]) @ np.column_stack([points, np.ones(len(d))]).T * d) + pair.t[:, None]).T @ pair.cameras[1].T
    with np.errstate(divide='ignore', invalid='ignore'):
        q = there[:, :2] / there[:, 2:]
    height, width = depths[1].shape
    seen = (d > 0) & (there[:, 2] > 0) & (np.rint(q) >= 0).all(axis=1) & (np.rint(q) < (width - 1, height - 1)).all(axis=1)
    x, y = np.rint(q[seen]).astype(int).T
    seen[seen] = abs(depths[1][y, x] - there[seen, 2]) <= DEPTH_TOLERANCE * there[seen, 2] + DEPTH_STEP
    near = np.linalg.norm(two[0][None, :, :2] - q[seen, None], axis=2) <= tolerance
    return seen.sum(), near.any(axis=1).sum(), (np.linalg.norm(found - q, axis=1) <= tolerance)[seen].sum()


def controlled(pair, count, tolerance):
    """Rows of controls.csv, then those of neighbours.csv."""
    rows, counts, files, key = [], [], pair.files, (pair.set, pair.sequence, pair.target)
    depths = [depth_of(file) for file in files]
    for sigma, methods in ((0, METHODS), *((sigma, NOISY) for sigma in NOISE)):
        for method in methods:
            one, two = described(*method, count, files[0]), described(*method, count, files[1], sigma)
            pairs, ratios = nearest(one[1], two[1])
            for ratio in RATIOS:
                points = moved((picture(files[0]), picture(files[1], sigma)), (one[0], two[0]), pairs[ratios < np.float32(ratio)])
                rows.append([*key, *method, sigma, ratio, by_find_relative_pose(points, pair)[0], len(points[0])])
    if all(depth is not None for depth in depths):
        contrast = contrast_of(picture(files[1]))
        for method, number in [*((method, count) for method in METHODS), *((method, number) for method in COUNTED for number in POINTS if number != count)]:
            found = neighbours(pair, described(*method, number, files[0]), described(*method, number, files[1]), depths, tolerance)
            counts.append([*key, *method, number, np.linalg.norm(pair.t), contrast, *found])
    return [(rows, counts)]


def controls(options):
    """Poses by other points and descriptors under equal conditions."""
    found = rows_of([(controlled, pair, options.points, options.tolerance) for pair in view_pairs(options.data)])
    write(options.out / 'controls.csv', [*NEIGHBOURS[:5], 'noise', 'ratio', 'error', 'matches'], sum((rows for rows, _ in found), []))
    write(options.out / 'neighbours.csv', NEIGHBOURS, sum((counts for _, counts in found), []))
